// The tables of the papers, run again.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/opencl.hpp>
#include <clgi/scene.hpp>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace clgi::lab {

struct BenchRow {
    std::string name;
    double paper = 0.0;           // the paper's figure
    double clgi = 0.0;            // ours
    double ratio = 0.0;           // above 1: ours is that many times faster
    std::optional<double> error;  // RMS of the 8-bit image, per cent
    std::optional<double> paper_error;
    std::optional<double> low_res_share;  // of the pixels, [0,1]
    std::optional<double> threshold;
    std::string unit;
};

struct BenchTable {
    std::string table;
    std::string device;
    std::string scene;
    double peak_gflops = 0.0;      // multiply-adds, measured between the rows
    double gather_gflops = 0.0;    // of image.gather, the row with most VPLs
    double gather_fraction = 0.0;  // of the peak
    std::vector<BenchRow> rows;
};

struct BenchSetup {
    cl::CommandQueue queue;  // with profiling
    Scene scene;             // the box with its mesh
    int width = 640;
    int height = 480;
    int repeats = 30;
    BuildOptions build;
    std::function<bool(double)> progress;  // share done; false stops
};

// Table 1 of [Cochran07]: frame rates for pairs of VPLs and negative VPLs, at the
// discontinuity threshold that leaves 87.5 % of the pixels at low resolution.
BenchTable bench_cochran1(const BenchSetup& setup);

// Table 2 of [Cochran07]: share of low-resolution pixels against error and frame rate, with 100
// VPLs and 50 negative VPLs (its second row is the first of Table 1).
BenchTable bench_cochran2(const BenchSetup& setup);

}  // namespace clgi::lab
