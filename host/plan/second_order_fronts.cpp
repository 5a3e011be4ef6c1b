// SPDX-License-Identifier: MIT
#include "plan/second_order_fronts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace clgi {
namespace {

constexpr float none = INFINITY;  // no pixel is lit in full

// Measured at 320x240 with 64 to 4096 VPLs, negative shares of 0.1, 1/3 and 1, steps of 4, 2 and
// 1 and thresholds from none to 0.005 (docs/results/accuracy.md says how): the front of frame time
// against error to the converged picture.
//
// With a few hundred VPLs, sampling errs so much more than interpolation that lighting any pixel
// in full is wasted. Half as many points across come to pay before low thresholds at a quarter do.
// Point lights reach the backs of everything: they need as many negative VPLs as others.
const SecondOrderFront fronts[] = {
    // spot: cornell, box with the bunny, corridor
    {0.2, {{4, none, 16}, {4, 0.2f, 700}, {2, 0.05f, 3000}, {2, 0.02f, 10000}, {1, 0.0f, 30000}}},
    // directional: sponza
    {0.2, {{4, none, 16}, {4, 0.2f, 700}, {2, 0.05f, 3000}, {2, 0.02f, 10000}, {1, 0.0f, 30000}}},
    // point: cornell, box with the bunny, house
    {1.0,
     {{4, none, 16},
      {4, 0.2f, 200},
      {2, 0.2f, 400},
      {2, 0.05f, 1000},
      {2, 0.02f, 4000},
      {1, 0.0f, 30000}}},
    // area: cornell, gallery
    {0.33, {{4, none, 16}, {4, 0.2f, 600}, {2, 0.05f, 8000}, {1, 0.0f, 30000}}},
};

}  // namespace

MainLight main_light(const DeviceScene& scene) {
    if (!scene.emissive().empty()) return MainLight::area;
    std::array<int, 3> counts{};
    for (const Light& light : scene.lights()) {
        const MainLight kind = light.kind == Light::Kind::spot          ? MainLight::spot
                               : light.kind == Light::Kind::directional ? MainLight::directional
                                                                        : MainLight::point;
        ++counts[static_cast<std::size_t>(kind)];
    }
    if (scene.environment()) ++counts[static_cast<std::size_t>(MainLight::directional)];
    return static_cast<MainLight>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

const SecondOrderFront& second_order_front(MainLight light) {
    return fronts[static_cast<std::size_t>(light)];
}

}  // namespace clgi
