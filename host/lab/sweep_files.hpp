// A sweep as files: table, data, plots, one page.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

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

// Both into a folder; error-<truth>.svg, error over time in log-log, a curve a method, the front
// marked; and index.html, one self-contained page with plots, fronts, pictures and differences.
// Returns a line to print when there are no plots, which is all that the page says then, else
// nothing.
std::string save_sweep(const Sweep& sweep, const SweepNote& note,
                       const std::filesystem::path& folder);

}  // namespace clgi::lab
