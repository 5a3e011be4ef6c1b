// A sweep as files: table, data, plots, one page.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/sweep.hpp"

namespace clgi::lab {

struct SweepNote {
    std::string command;  // that made it
    std::string version;  // of clgi
};

// sweep.csv: one row a point.
std::string sweep_csv(const Sweep& sweep);
// sweep.json: the same, with device, scene and summary.
std::string sweep_json(const Sweep& sweep, const SweepNote& note);
// Error over time in log-log against one truth, a curve a method, the front marked. Empty, with
// the reason in `why`, when gnuplot is not there. folder: where it may work.
std::string error_plot(const Sweep& sweep, std::size_t truth, const std::filesystem::path& folder,
                       std::string& why);
// One self-contained page with plots, fronts, pictures and differences. plots: one a truth.
std::string sweep_page(const Sweep& sweep, const SweepNote& note,
                       const std::vector<std::string>& plots);

// All of them into a folder; returns a line to print when there are no plots, else nothing.
std::string save_sweep(const Sweep& sweep, const SweepNote& note,
                       const std::filesystem::path& folder);

}  // namespace clgi::lab
