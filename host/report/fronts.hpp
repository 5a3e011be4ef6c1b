// Which settings of second-order illumination pay, by what lights the scene: measured once, as
// data.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <vector>

namespace clgi::report {

// By what most of the scene's lamps are; an environment is one directional lamp more, as it lights
// by directions. Emissive surfaces come before all.
enum class SceneClass { spot, directional, point, area };

SceneClass classify(const DeviceScene& scene);

// How finely indirect light is spread over the pixels. A rung pays from so many VPLs on: with
// fewer, more VPLs at the rung below take more error away in the same time.
struct Rung {
    int step;         // low_resolution_step
    float threshold;  // discontinuity_threshold
    int from_lights;
};

// The Pareto front of time against error, from cheap to dear.
struct Front {
    double negative_share;  // negative VPLs for each VPL
    std::vector<Rung> rungs;
};

const Front& second_order_front(SceneClass scene_class);

}  // namespace clgi::report
