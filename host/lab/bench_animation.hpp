// What a step of an animated scene costs: curves on the host, vertices on the device.
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

struct AnimationRow {
    std::string scene;
    std::size_t vertices = 0;
    double curves_us = 0.0;  // sampling the first clip on the host: the median over repeats
    double step_us = 0.0;    // from the pose to vertices and clusters, the wait for them included
    double ns_per_vertex = 0.0;  // of the step
};

struct AnimationSetup {
    cl::CommandQueue queue;
    BuildOptions build;
    int repeats = 200;
    std::function<bool(double)> progress;  // share done; false ends it with Error
};

// A row for each of the named scenes. Throws Error for one without animation.
std::vector<AnimationRow> bench_animation(const AnimationSetup& setup,
                                          const std::vector<std::pair<std::string, Scene>>& scenes);

}  // namespace clgi::lab
