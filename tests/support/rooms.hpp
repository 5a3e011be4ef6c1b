// Rooms with a lamp in them, to be lit by methods for many bounces.
// SPDX-License-Identifier: MIT
#pragma once

#include "scenes.hpp"

namespace clgi::test {

// A closed room with boxes of random size and colour, on the floor and in the air.
inline Scene furnished_room(std::uint64_t seed) {
    Scene scene = plain_scene(glm::vec3(0.7f, 0.65f, 0.6f));
    Random random(seed);
    add_box(scene, {0, 0, 0}, {4, 2.5, 3}, -1);
    for (int k = 0; k < 6; ++k) {
        Material material;
        for (int c = 0; c < 3; ++c) material.base_color[c] = static_cast<float>(random(0.2, 0.8));
        const double x = random(0.1, 3.2), z = random(0.1, 2.2), y = random(0.3, 1.2);
        const glm::dvec3 low(x, k % 2 == 0 ? 0.0 : y, z);
        const glm::dvec3 size(random(0.3, 0.7), random(0.3, 1.2), random(0.3, 0.7));
        add_box(scene, low, low + size, 1, add_material(scene, material));
    }
    scene.lights = {point_light({2.0, 2.2, 1.5})};
    scene.lights[0].intensity = {100.0f, 90.0f, 80.0f};
    return scene;
}

// Two chambers, and a slit of 30 cm from floor to ceiling in the wall between them. One is lit.
inline Scene chambers() {
    Scene scene = plain_scene(glm::vec3(0.7f));
    add_box(scene, {0, 0, 0}, {4, 2.5, 3}, -1);
    add_box(scene, {1.95, 0, 0}, {2.05, 2.5, 1.3}, 1);
    add_box(scene, {1.95, 0, 1.6}, {2.05, 2.5, 3}, 1);
    scene.lights = {point_light({1.0, 1.9, 1.2})};
    scene.lights[0].intensity = {100.0f, 90.0f, 80.0f};
    return scene;
}

// Four double-sided shelves across a room: reflecting light and letting it through at once
// diverges.
inline Scene shelves(float albedo) {
    Scene scene = plain_scene(glm::vec3(albedo));
    scene.materials[0].double_sided = true;
    add_box(scene, {0, 0, 0}, {1, 1, 1}, -1);
    for (const double y : {0.2, 0.4, 0.6, 0.8})
        add_quad(scene, {glm::dvec3(0.1, y, 0.1), {0.1, y, 0.9}, {0.9, y, 0.9}, {0.9, y, 0.1}});
    scene.lights = {point_light({0.5, 0.9, 0.5})};
    return scene;
}

}  // namespace clgi::test
