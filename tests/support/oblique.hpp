// A scene in which nothing is symmetric, grey or along an axis: an open, crooked room of coloured
// surfaces, dull and glossy, lit by every kind of source in colours of its own.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "scenes.hpp"

namespace clgi::test {

inline glm::vec3 random_colour(Random& random, double low, double high) {
    return {random(low, high), random(low, high), random(low, high)};
}

inline glm::vec3 random_direction(Random& random) {
    for (;;) {
        const glm::vec3 out(random(-1, 1), random(-1, 1), random(-1, 1));
        const float length = glm::length(out);
        if (length > 0.1f && length < 1.0f) return out / length;
    }
}

// Surfaces alone. Every corner has a colour and a normal of its own.
inline Scene oblique_room() {
    Random random(2007);
    Scene scene;
    // Dull, half metal, rough metal, smooth plastic.
    const float metallic[] = {0.0f, 0.6f, 1.0f, 0.0f}, roughness[] = {1.0f, 0.5f, 0.7f, 0.35f};
    for (int m = 0; m < 4; ++m) {
        Material material;
        material.base_color = glm::vec4(random_colour(random, 0.3, 0.95), 1.0f);
        material.metallic = metallic[m];
        material.roughness = roughness[m];
        material.specular = m == 0 ? 0.0f : 1.0f;
        add_material(scene, material);
    }
    const auto add = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                         std::uint32_t material) {
        add_triangle(scene, a, b, c, material);
        for (int k = 0; k < 3; ++k) {
            glm::vec3& normal = scene.normals[scene.normals.size() - 3 + k];
            normal = glm::normalize(normal + 0.15f * random_direction(random));
            scene.colors.emplace_back(random_colour(random, 0.4, 1.0), 1.0f);
        }
    };
    // A box whose corners are out of place, without a lid.
    glm::dvec3 corner[8];
    for (int k = 0; k < 8; ++k)
        corner[k] = glm::dvec3(k & 1 ? 1.1 : -0.9, k & 2 ? 0.8 : -0.7, k & 4 ? 1.3 : -1.0) +
                    0.2 * glm::dvec3(random_direction(random));
    const int faces[5][4] = {{0, 4, 5, 1}, {0, 2, 6, 4}, {1, 5, 7, 3}, {0, 1, 3, 2}, {4, 6, 7, 5}};
    for (int f = 0; f < 5; ++f) {
        add(corner[faces[f][0]], corner[faces[f][1]], corner[faces[f][2]], f % 4);
        add(corner[faces[f][0]], corner[faces[f][2]], corner[faces[f][3]], (f + 1) % 4);
    }
    // Inside: one that both sides send from, one whose back does not, both in the way of light.
    Material both = scene.materials[1];
    both.base_color = {0.85f, 0.35f, 0.6f, 1.0f};
    both.double_sided = true;
    const std::uint32_t sheet = add_material(scene, both);
    add({-0.55, -0.25, 0.35}, {0.05, -0.45, 0.55}, {-0.25, 0.25, 0.75}, sheet);
    add({0.35, -0.35, -0.45}, {0.75, -0.15, -0.15}, {0.45, 0.15, -0.55}, 3);
    return scene;
}

inline void add_oblique_lamp(Scene& scene) {
    Material lamp;
    lamp.base_color = {0.2f, 0.3f, 0.1f, 1.0f};
    lamp.emission = {9.0f, 5.0f, 2.0f};
    const std::uint32_t material = add_material(scene, lamp);
    // Shines down and towards +x; its other side is dark.
    add_triangle(scene, {-0.62, 0.42, -0.5}, {-0.42, 0.36, -0.42}, {-0.52, 0.56, -0.33}, material);
    if (!scene.colors.empty()) scene.colors.resize(scene.positions.size(), glm::vec4(1.0f));
}

inline Light oblique_spot() {
    Light light = spot_light({0.45, 0.6, 0.3}, {-0.5f, -0.8f, -0.25f}, 0.75);
    light.inner_angle = 0.3f;
    light.intensity = {5.0f, 3.0f, 7.0f};
    light.range = 2.1f;
    return light;
}

inline Light oblique_point() {
    Light light = point_light({-0.3, 0.45, 0.15});
    light.intensity = {1.5f, 2.5f, 0.8f};
    light.range = 1.4f;
    return light;
}

inline Light oblique_sun() {
    Light light = directional_light({0.3f, -0.9f, 0.2f});
    light.intensity = {2.0f, 1.1f, 3.0f};
    return light;
}

// Wider than 60 degrees: seen through a cube.
inline Light oblique_wide_spot() {
    Light light = spot_light({0.1, 0.3, -0.45}, {0.6f, -0.55f, 0.4f}, 1.3);
    light.inner_angle = 0.5f;
    light.intensity = {0.9f, 2.2f, 1.6f};
    return light;
}

// Narrower than rejection can serve: its cone is mapped.
inline Light oblique_thin_spot() {
    Light light = spot_light({0.2, 0.7, -0.1}, {-0.2f, -0.9f, 0.15f}, 0.004);
    light.inner_angle = 0.002f;
    light.intensity = {60000.0f, 90000.0f, 30000.0f};
    return light;
}

inline Scene oblique_scene() {
    Scene scene = oblique_room();
    add_oblique_lamp(scene);
    scene.lights = {oblique_spot(), oblique_point(), oblique_sun(), oblique_wide_spot(),
                    oblique_thin_spot()};
    return scene;
}

inline Camera oblique_camera() {
    Camera camera = camera_at({0.35, 0.75, 1.05}, {-0.2, -0.45, -0.3}, 1.1f);
    // Turned about its axis.
    const float c = std::cos(0.4f), s = std::sin(0.4f);
    const glm::vec3 right = camera.right, up = camera.up;
    camera.right = c * right + s * up;
    camera.up = c * up - s * right;
    return camera;
}

}  // namespace clgi::test
