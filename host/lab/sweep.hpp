// Accuracy against time: the settings of a method varied one by one and together, each result
// measured against ground truth. What sweeps of pictures, atlases and vertices have in common.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/io/image.hpp>
#include <clgi/opencl.hpp>
#include <clgi/scene.hpp>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace clgi::lab {

struct SweepSetup {
    cl::CommandQueue queue;
    const Scene& scene;
    bool quick = false;                    // fewer settings, fewer samples
    bool solver = true;                    // what to measure: the method that runs on the device,
    bool path_tracer = true;               // and the baseline
    int rounds = 3;                        // through all settings
    int reference_samples = 192;           // a pixel or texel
    BuildOptions build;                    // of all series but "math"
    std::filesystem::path folder;          // where references are kept between runs; must exist
    std::function<bool(double)> progress;  // share done; false cancels
};

// What results are compared with.
struct SweepTruth {
    std::string name;     // "full"
    std::string effects;  // for reference::parse_effects
    io::Image picture;
    double noise = 0.0;  // standard error over the mean, subtracted from all errors
};

// What is measured of a method, by the name that tables have for it.
struct SweepSetting {
    std::string method;  // one of Sweep::methods, or path_tracer_name
    std::string series;  // the knob that is varied alone, or "grid"; of the path tracer, the truth
    std::map<std::string, std::string> knobs;
};

struct SweepPoint : SweepSetting {
    double milliseconds = 0.0;  // median of a whole frame or bake
    // What is done once before all frames and is no part of one: visible sets, links, a bake.
    std::optional<double> once_milliseconds;
    std::vector<double> error;  // [truths] relative_error() against each
    // What the method says of its own error, without a reference, by the name of a truth.
    std::map<std::string, double> estimated_error;
    double energy = 0.0;  // mean over the mean of the first truth
    // The method has no result: its iteration diverged. The picture is what it shows instead, and
    // on no front.
    bool given_up = false;
    std::vector<bool> front;  // [truths] on its method's Pareto front against this truth
    io::Image picture;
};
inline constexpr const char* path_tracer_name = "path tracer";

enum class SweepOf { pictures, atlas, vertices };

struct Sweep {
    SweepOf of = SweepOf::pictures;
    std::string scene, device;
    std::size_t triangles = 0;
    int width = 0;  // pixels, texels or vertices, the last row of these filled up
    int height = 0;
    std::vector<std::string> methods;  // without the path tracer
    std::vector<std::string> knobs;    // of all methods: the columns of tables
    std::vector<SweepTruth> truths;
    std::vector<SweepPoint> points;
    std::size_t non_finite = 0;  // packets of numbers that were not finite, in all results
};

}  // namespace clgi::lab
