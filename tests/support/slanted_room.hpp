// A convex room without a right angle, and coloured lights for it.
// SPDX-License-Identifier: MIT
#pragma once

#include "scenes.hpp"

namespace clgi::test {

inline void add_coloured_lights(Scene& scene) {
    scene.lights = {point_light({0.3, 1.1, -0.4}, 1.0f),
                    spot_light({-0.5, 1.6, 0.2}, {0.4, -1.0, 0.1}, 0.6, 6.0f)};
    scene.lights[0].intensity = {3.0f, 1.0f, 0.5f};
    scene.lights[1].intensity = {0.5f, 2.0f, 6.0f};
}

inline Scene slanted_room() {
    Scene scene = plain_scene({0.7f, 0.5f, 0.3f});
    const glm::dvec3 low[4] = {{-1, 0, 1.2}, {1.2, 0, 0.9}, {0.9, 0, -1}, {-1.1, 0, -1.2}};
    glm::dvec3 high[4];
    for (int k = 0; k < 4; ++k) high[k] = low[k] * 0.8 + glm::dvec3(0, 2, 0);
    add_quad(scene, {low[0], low[1], low[2], low[3]});
    add_quad(scene, {high[3], high[2], high[1], high[0]});
    for (int k = 0; k < 4; ++k)
        add_quad(scene, {low[(k + 1) % 4], low[k], high[k], high[(k + 1) % 4]});
    add_coloured_lights(scene);
    return scene;
}

}  // namespace clgi::test
