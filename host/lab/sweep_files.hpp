// A sweep as files: table, data, plots, one page, and one picture of each system side by side.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "lab/drawing.hpp"
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

// ---- the sheet of pictures ----------------------------------------------------------------------

// Of a method's points, the one with the least error against the first truth whose time is at most
// `milliseconds`; if none is so fast, the fastest. Of the path tracer, those with all of that
// truth's light. Null for a method without points that have a result.
const SweepPoint* shown_point(const Sweep& sweep, const std::string& method, double milliseconds);

struct SheetPanel {
    const io::Image* picture = nullptr;  // in the sweep
    std::array<std::string, 2> caption;  // two lines
};
using Sheet = std::vector<SheetPanel>;

// The first truth, a panel for each of the sweep's methods, in their order, and the path tracer.
// Methods without such a point have no panel. Throws Error for a sweep that is not of pictures.
Sheet contact_sheet(const Sweep& sweep, double milliseconds);

// All pictures with the exposure of the first, in three columns with their captions; below each
// other and without captions where nothing can be drawn.
Raster draw_sheet(const Sheet& sheet);

}  // namespace clgi::lab
