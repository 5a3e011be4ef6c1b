// A small valid scene from an input's choices: a room or loose triangles of any size and place,
// with needles and triangles without area, every kind of light and material.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>

#include "fuzz/choices.hpp"
#include "scenes.hpp"

namespace clgi::fuzz {

inline glm::vec3 color(Choices& choices) {
    return glm::vec3(choices.between(0, 1), choices.between(0, 1), choices.between(0, 1));
}

inline glm::dvec3 place(Choices& choices) {
    return {choices.between(-1, 1), choices.between(-1, 1), choices.between(-1, 1)};
}

inline glm::vec3 direction(Choices& choices) {
    const glm::dvec3 drawn = place(choices);
    const double length = glm::length(drawn);
    return length > 1e-3 ? glm::vec3(drawn / length) : glm::vec3(0, -1, 0);
}

// Strength of light: from nothing over the usual to far too much.
inline float strength(Choices& choices) {
    return choices.one_in(12) ? 0.0f : static_cast<float>(choices.power_of_two(-20, 30));
}

inline void add_materials(Choices& choices, Scene& scene) {
    const int count = choices.integer(1, 4);
    for (int i = 0; i < count; ++i) {
        Material material;
        material.base_color = glm::vec4(color(choices), 1.0f);
        if (choices.one_in(4)) material.metallic = static_cast<float>(choices.between(0, 1));
        if (choices.one_in(4)) {
            material.roughness = static_cast<float>(choices.between(0, 1));
            material.specular = 1.0f;
        }
        if (choices.one_in(6)) material.emission = strength(choices) * color(choices);
        material.double_sided = choices.one_in(3);
        if (choices.one_in(6)) {
            material.alpha_mode = AlphaMode::mask;
            material.base_color.w = static_cast<float>(choices.between(0, 1));
        }
        scene.materials.push_back(material);
    }
}

inline void add_triangles(Choices& choices, Scene& scene) {
    const auto material = [&] {
        return static_cast<std::uint32_t>(
            choices.integer(0, static_cast<int>(scene.materials.size()) - 1));
    };
    if (choices.coin()) test::add_box(scene, glm::dvec3(-1), glm::dvec3(1), -1, material());
    if (choices.one_in(3)) {
        const glm::dvec3 low = 0.8 * place(choices);
        test::add_box(scene, low, low + glm::dvec3(choices.power_of_two(-8, -1)), 1, material());
    }
    if (choices.one_in(3)) test::add_floor(scene, 1.0, choices.between(-1, 1), material());
    const int loose = choices.integer(0, 12);
    for (int i = 0; i < loose; ++i) {
        const glm::dvec3 a = place(choices), b = place(choices);
        switch (choices.integer(0, 5)) {
            case 0:
                test::add_triangle(scene, a, a, b, material());
                break;  // no area
            case 1:
                test::add_triangle(scene, a, b, 0.5 * (a + b), material());
                break;
            case 2:  // a needle
                test::add_triangle(scene, a, b, a + 1e-7 * place(choices), material());
                break;
            case 3:  // a island
                test::add_triangle(scene, a, a + 1e-6 * b, a + 1e-6 * place(choices), material());
                break;
            default:
                test::add_triangle(scene, a, b, place(choices), material());
                break;
        }
    }
}

inline void add_lights(Choices& choices, Scene& scene) {
    const int count = choices.integer(0, 3);
    for (int i = 0; i < count; ++i) {
        Light light;
        light.kind =
            choices.any_of({Light::Kind::spot, Light::Kind::point, Light::Kind::directional});
        light.position = 0.9 * place(choices);
        light.direction = direction(choices);
        light.intensity = strength(choices) * color(choices);
        if (choices.one_in(4)) light.range = static_cast<float>(choices.power_of_two(-6, 3));
        light.outer_angle = static_cast<float>(choices.between(1e-4, 1.5707963));
        light.inner_angle = choices.coin()
                                ? light.outer_angle
                                : static_cast<float>(choices.between(0, 0.99) * light.outer_angle);
        scene.lights.push_back(light);
    }
    if (choices.one_in(4)) {
        Environment sky;
        sky.factor = strength(choices) * color(choices);
        sky.rotation = static_cast<float>(choices.between(-7, 7));
        if (choices.coin()) {
            sky.width = choices.integer(1, 8);
            sky.height = choices.integer(1, 4);
            for (int i = 0; i < sky.width * sky.height; ++i)
                sky.texels.push_back(choices.one_in(8) ? glm::vec3(1e4f) : color(choices));
        }
        scene.environment = sky;
    }
}

inline void add_texture(Choices& choices, Scene& scene) {
    Texture checker;
    checker.width = checker.height = 2;
    for (int i = 0; i < 16; ++i)
        checker.rgba.push_back(static_cast<std::uint8_t>(choices.integer(0, 255)));
    checker.nearest = choices.coin();
    scene.textures.push_back(checker);
    scene.uvs.resize(scene.positions.size());
    for (std::size_t i = 0; i < scene.uvs.size(); ++i)
        scene.uvs[i] = glm::vec4(0.3f * static_cast<float>(i % 7), 0.7f * static_cast<float>(i % 3),
                                 0.0f, 0.0f);
    scene.materials[0].base_texture.texture = 0;
}

inline Scene random_scene(Choices& choices) {
    Scene scene;
    add_materials(choices, scene);
    if (!choices.one_in(16)) add_triangles(choices, scene);
    add_lights(choices, scene);
    if (choices.one_in(4)) add_texture(choices, scene);

    // Sizes of a grain and of a country, here and far away.
    const double size = choices.one_in(3) ? choices.power_of_two(-13, 20) : 1.0;
    const glm::dvec3 away =
        choices.one_in(4) ? choices.power_of_two(0, 20) * place(choices) : glm::dvec3(0.0);
    for (glm::dvec3& position : scene.positions) position = size * position + away;
    for (Light& light : scene.lights) {
        light.position = size * light.position + away;
        light.range *= static_cast<float>(size);
    }
    return scene;
}

inline Camera random_camera(Choices& choices, const Scene& scene) {
    Camera camera = default_camera(scene);
    if (choices.one_in(3)) {  // anywhere, also inside of things
        const Bounds box = bounds(scene);
        const glm::dvec3 share = 0.5 + 0.5 * place(choices);
        camera.position = box.low + share * (box.high - box.low);
    }
    if (choices.one_in(4)) {
        camera.kind = Camera::Kind::orthographic;
        camera.half_height = static_cast<float>(choices.power_of_two(-10, 10));
    }
    return camera;
}

}  // namespace clgi::fuzz
