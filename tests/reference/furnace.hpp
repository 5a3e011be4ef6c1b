// A scene whose light is known everywhere.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>

#include "scenes.hpp"

namespace clgi {

// A closed box whose walls emit and reflect, each channel in its own way: radiance L / (1 - rho)
// everywhere.
struct Furnace {
    Furnace() {
        Material material;
        material.base_color = glm::vec4(0.5f, 0.2f, 0.8f, 1.0f);
        material.emission = {3.0f, 1.0f, 2.0f};
        test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1, test::add_material(scene, material));
    }
    Scene scene = test::plain_scene();
    Camera camera = test::camera_at({0.2, 0.1, 0.3}, {1, 0.4, -0.2});
    glm::vec3 radiance{6.0f, 1.25f, 10.0f};
    double luminance = 0.2126 * 6.0 + 0.7152 * 1.25 + 0.0722 * 10.0;
    static constexpr int width = 40, height = 30;
};

}  // namespace clgi
