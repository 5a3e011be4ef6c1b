// A scene with every kind of light.
// SPDX-License-Identifier: MIT
#pragma once

#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {

// Every kind of source: a lamp, a sun, a weak lamp, sixteen directions, sixteen samples.
inline Scene scene_of_all() {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 2.0);
    Material glowing;
    glowing.emission = glm::vec3(3.0f, 2.0f, 1.0f);
    test::add_floor(scene, 0.5, 1.0, test::add_material(scene, glowing));
    scene.lights = {test::spot_light({0, 2, 0}, {0, -1, 0}, 0.5),
                    test::directional_light({0, -1, 0}), test::point_light({1, 1, 1}, 0.01f)};
    scene.environment = test::gradient_sky();
    return scene;
}

}  // namespace clgi
