// How fast hemicubes around surface points are drawn, in both forms that there are.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/opencl.hpp>
#include <clgi/scene.hpp>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace clgi::lab {

// One scene drawn in one form: a view a work-item ("views"), or triangles in parallel with lists of
// large ones ("lists"); depth alone, or depth with triangle ("visibility").
struct ViewsRow {
    std::string scene;
    std::string form;
    std::size_t triangles = 0;
    double hemicube_ms = 0.0;           // device time of one hemicube: the median over repeats
    double triangles_per_second = 0.0;  // of the scene, times hemicubes per second
    double gigabytes_per_second = 0.0;  // of the least that must move: each face written once, each
                                        // triangle and vertex read once a hemicube
    double roof_share = 0.0;            // of the measured copy bandwidth
    bool taken = false;                 // the form that the library chooses here
};

struct ViewsSetup {
    cl::CommandQueue queue;  // with profiling
    BuildOptions build;
    int size = 256;      // pixels, side of a whole face
    int hemicubes = 32;  // drawn together, around centroids of triangles spread over the scene
    int repeats = 10;
    std::function<bool(double)> progress;  // share done; false ends it with Error
};

struct ViewsTable {
    double copy_gigabytes_per_second = 0.0;  // read and written, measured in the same run
    std::vector<ViewsRow> rows;
};

ViewsTable bench_views(const ViewsSetup& setup,
                       const std::vector<std::pair<std::string, Scene>>& scenes);

}  // namespace clgi::lab
