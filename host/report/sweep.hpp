// Accuracy against time: a method's knobs turned one by one and together, each picture measured
// against ground truth.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <clgi/reference.hpp>
#include <clgi/scene.hpp>
#include <clgi/solvers/second_order.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace clgi::report {

struct SweepSetup {
    cl::CommandQueue queue;
    const Scene& scene;
    int camera = 0;
    int width = 320;
    int height = 240;
    bool quick = false;        // fewer settings, fewer samples
    bool second_order = true;  // which methods
    bool path_tracer = true;
    int rounds = 3;               // through all settings; each times two frames
    int reference_samples = 192;  // a pixel
    BuildOptions build;           // of all series but "math"
    std::filesystem::path folder;          // where references are kept between runs; must exist
    std::function<bool(double)> progress;  // share done; false cancels
};

// The truths that pictures are held against.
enum Truth { all_light, one_bounce, unshadowed_bounce };
constexpr int truths = 3;
extern const char* const truth_names[truths];    // "full", "one-bounce", "unshadowed"
extern const char* const truth_effects[truths];  // for reference::parse_effects

struct SweepPoint {
    std::string method;  // "second-order" or "path tracer"
    std::string series;  // the knob that is turned alone, or "grid"
    std::map<std::string, std::string> knobs;
    double milliseconds = 0.0;  // median of a whole frame
    double error[truths] = {};  // relative_error() against each
    double energy = 0.0;        // mean over the mean of the full truth
    bool front[truths] = {};    // on its method's Pareto front against this truth
    io::Image picture;
};

struct Sweep {
    std::string scene, device;
    std::size_t triangles = 0;
    int width = 0;
    int height = 0;
    std::vector<SweepPoint> points;
    io::Image truth[truths];
    double truth_noise[truths] = {};  // standard error over the mean, taken out of all errors
};

// Throws what its parts throw, and Error when cancelled.
Sweep sweep(const SweepSetup& setup);

// The knob settings that a sweep tries for a method, by series. The first of each series that
// turns one knob is that knob's least accurate setting; that of "math" is strict math on floats.
struct Settings {
    std::string series;
    std::map<std::string, std::string> knobs;
    SecondOrderOptions options;
};
std::vector<Settings> second_order_settings(int width, int height, bool quick,
                                            const BuildOptions& build = {});

}  // namespace clgi::report
