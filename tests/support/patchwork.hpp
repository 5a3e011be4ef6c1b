// A heap of tilted triangles that differ in everything, and views onto it from all kinds of
// windows.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "drawing.hpp"
#include "scenes.hpp"

namespace clgi::test {

inline glm::vec3 random_vec3(Random& random, double low, double high) {
    return {random(low, high), random(low, high), random(low, high)};
}

inline TextureSlot random_slot(Random& random, int textures) {
    TextureSlot slot;
    slot.texture = random.integer(-1, textures - 1);
    slot.uv_set = random.integer(0, 1);
    // A turn, a shear and two scales of different size.
    slot.transform = glm::mat3(random(0.4, 2.0), random(-1, 1), 0, random(-1, 1), random(-2, -0.4),
                               0, random(-1, 1), random(-1, 1), 1);
    return slot;
}

// Random triangles of twelve materials in front of each other, some seen from behind, with
// shading normals that lean far over, colours at every corner and both UV sets in use.
inline Scene patchwork(int count, std::uint64_t seed, bool textured = true) {
    Random random(seed);
    Scene scene = plain_scene();
    scene.materials.clear();
    for (int t = 0; textured && t < 5; ++t) {
        Texture texture;
        texture.width = 3 + 4 * t;
        texture.height = 8 - t;
        texture.wrap_s = static_cast<Wrap>(t % 3);
        texture.wrap_t = static_cast<Wrap>((t + 1) % 3);
        texture.nearest = t == 4;
        for (int i = 0; i < 4 * texture.width * texture.height; ++i)
            texture.rgba.push_back(static_cast<std::uint8_t>(random.integer(30, 255)));
        scene.textures.push_back(texture);
    }
    for (int m = 0; m < 12; ++m) {
        Material material;
        material.base_color = glm::vec4(random_vec3(random, 0.2, 1.0), 1.0f);
        material.metallic = static_cast<float>(random(0, 1));
        material.roughness = static_cast<float>(random(0.2, 1));
        material.specular = 0.75f;
        if (m % 3 != 2) material.emission = random_vec3(random, 1.0, 50.0);
        material.double_sided = m % 2 == 0;
        if (textured) {
            material.base_texture = random_slot(random, 5);
            material.emission_texture = random_slot(random, 5);
        }
        scene.materials.push_back(material);
    }
    for (int t = 0; t < count; ++t) {
        const glm::dvec3 at(random_vec3(random, -0.8, 0.8));
        glm::dvec3 corner[3];
        for (glm::dvec3& c : corner) c = at + glm::dvec3(random_vec3(random, -0.4, 0.4));
        add_triangle(scene, corner[0], corner[1], corner[2],
                     static_cast<std::uint32_t>(random.integer(0, 11)));
    }
    for (glm::vec3& normal : scene.normals)
        normal = glm::normalize(normal + random_vec3(random, -0.8, 0.8));
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        scene.colors.emplace_back(random_vec3(random, 0.1, 1.0), random(0.1, 1.0));
        if (textured) scene.uvs.emplace_back(random_vec3(random, -1, 2), random(-1, 2));
    }
    return scene;
}

inline Camera tilted_camera() {
    Camera camera = camera_at({1.3, 0.9, 1.9}, {0.1, -0.1, 0.0}, 0.7f);
    const glm::vec3 right = camera.right;  // rolled by 0.4 radians
    camera.right = std::cos(0.4f) * right + std::sin(0.4f) * camera.up;
    camera.up = std::cos(0.4f) * camera.up - std::sin(0.4f) * right;
    return camera;
}

enum class Looking { perspective, orthographic, aside, orthographic_aside };

inline View looking(Looking how, const DeviceScene& placed, int width, int height) {
    Camera camera = tilted_camera();
    if (how == Looking::orthographic || how == Looking::orthographic_aside) {
        camera.kind = Camera::Kind::orthographic;
        camera.half_height = 0.8f;
        camera.near = 0.3f;
    }
    View view = make_view(camera, placed.frame(), width, height);
    if (how == Looking::aside || how == Looking::orthographic_aside) {
        // A part of the window, away from its middle, as halves of a hemicube have it.
        view.window.x = -0.3f * view.right.w;
        view.window.y = 0.25f * view.up.w;
        view.right.w *= 0.6f;
        view.up.w *= 0.7f;
    }
    return view;
}

inline std::string looking_name(const testing::TestParamInfo<Looking>& info) {
    const char* names[] = {"perspective", "orthographic", "aside", "orthographic_aside"};
    return names[static_cast<int>(info.param)];
}

}  // namespace clgi::test
