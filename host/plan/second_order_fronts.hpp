// Which settings of second-order illumination pay, by what lights the scene: measured once, as
// data.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/device_scene.hpp>
#include <vector>

namespace clgi {

// The kind of most of the scene's lights; an environment counts as one directional light more, as
// it lights by directions. Emissive surfaces come before all.
enum class MainLight { spot, directional, point, area };

CLGI_API MainLight main_light(const DeviceScene& scene);

// How finely indirect light is spread over the pixels. It pays from so many VPLs on: with fewer,
// more VPLs at the coarser refinement take more error away in the same time.
struct Refinement {
    int step;         // low_resolution_step
    float threshold;  // discontinuity_threshold
    int from_vpls;
};

// The Pareto front of time against error, from cheap to dear.
struct SecondOrderFront {
    double negative_share;  // negative VPLs for each VPL
    std::vector<Refinement> refinements;
};

CLGI_API const SecondOrderFront& second_order_front(MainLight light);

}  // namespace clgi
