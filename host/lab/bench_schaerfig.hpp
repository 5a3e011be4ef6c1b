// Table 1 of [Schaerfig16], run again: seconds of whole bakes against numbers of VPLs.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/opencl.hpp>
#include <clgi/scene.hpp>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace clgi::lab {

// One bake: from the scene's buffers to the filled atlas, the layout on the host included; kernels
// are built before.
struct SchaerfigRow {
    std::string name;             // "corridor, 1600 VPLs"
    std::string filling;          // how texels are lit: "gather"
    std::optional<double> paper;  // seconds
    double clgi = 0.0;            // seconds: the median of up to three
    std::optional<double> ratio;  // above 1: ours is that many times faster
    double layout = 0.0;          // seconds of these on the host: patches, VPLs, charts, texels
    std::uint32_t vpls = 0;
    std::size_t texels = 0;
};

struct SchaerfigTable {
    std::string device;
    double peak_gflops = 0.0;  // multiply-adds, measured between the rows
    std::vector<SchaerfigRow> rows;
};

struct SchaerfigSetup {
    cl::CommandQueue queue;  // with profiling
    BuildOptions build;
    std::uint32_t most_vpls = 1600;        // of 100, 400, 1600, 6400, 25600
    int atlas_size = 512;                  // texels, side
    std::function<bool(double)> progress;  // share done; false ends it with Error
};

// Scenes by the names "corridor", "cornell" and "sponza" have the paper's figures beside ours.
SchaerfigTable bench_schaerfig1(const SchaerfigSetup& setup,
                                const std::vector<std::pair<std::string, Scene>>& scenes);

}  // namespace clgi::lab
