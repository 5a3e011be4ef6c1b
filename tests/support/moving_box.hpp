// A room of coloured walls through which a clip carries a box.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>

#include "planned_pictures.hpp"
#include "scenes.hpp"

namespace clgi::test {

// A clip that carries vertices of a part so far in a second.
inline void slide(Scene& scene, std::uint32_t first, std::uint32_t end, std::uint32_t part,
                  const glm::vec3& way) {
    Animation animation;
    animation.nodes.resize(1);
    AnimationClip clip;
    clip.duration = 1.0;
    clip.curves = {{Interpolation::linear, 3, {0.0f, 1.0f}, {0, 0, 0, way.x, way.y, way.z}}};
    clip.channels = {{ChannelTarget::translation, 0, 0}};
    animation.clips = {clip};
    PosedRange range;
    range.first_vertex = first;
    range.vertex_count = end - first;
    range.part = part;
    animation.ranges = {range};
    for (std::uint32_t v = first; v < end; ++v) {
        animation.rest_positions.emplace_back(scene.positions[v]);
        animation.rest_normals.push_back(scene.normals[v]);
    }
    scene.animation = animation;
}

// Triangles 24 to 35 are the box, which a second carries from the red wall to the green one. The
// lamp is a spot that lights the floor.
inline Scene moving_box_room() {
    Scene scene = plain_scene({0.7f, 0.7f, 0.65f});
    const auto material = [&](const glm::vec3& colour) {
        Material out;
        out.base_color = glm::vec4(colour, 1.0f);
        return add_material(scene, out);
    };
    const std::uint32_t red = material({0.75f, 0.1f, 0.08f}), green = material({0.1f, 0.6f, 0.15f});
    const std::uint32_t white = material(glm::vec3(0.7f));
    add_box(scene, {-2, 0, -2}, {2, 2.2, 2}, -1);
    scene.triangles[0].material = scene.triangles[1].material = red;
    scene.triangles[2].material = scene.triangles[3].material = green;
    add_box(scene, {-0.4, 0.0, -1.9}, {0.4, 0.5, -1.3}, 1);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const auto from = static_cast<std::uint32_t>(scene.triangles.size());
    add_box(scene, {-1.7, 0.4, -1.0}, {-1.2, 1.0, -0.5}, 1, white);
    const auto end = static_cast<std::uint32_t>(scene.positions.size());
    const auto to = static_cast<std::uint32_t>(scene.triangles.size());
    add_box(scene, {1.0, 0.0, -1.9}, {1.3, 0.3, -1.6}, 1);
    scene.parts = {{"room", 0, from},
                   {"box", from, to - from},
                   {"block", to, static_cast<std::uint32_t>(scene.triangles.size()) - to}};

    slide(scene, first, end, 1, {2.9f, 0.2f, 0.1f});
    scene.moving_bounds = motion_bounds(scene, 0);
    scene.lights = {spot_light({0.0, 2.1, 0.2}, {0.0f, -1.0f, -0.15f}, 0.7, 30.0f)};
    scene.lights[0].intensity *= glm::vec3(1.0f, 0.9f, 0.7f);
    scene.cameras = {camera_at({0.0, 1.3, 1.8}, {0.1, 0.7, -1.0}, 1.1f)};
    return scene;
}

// Which pixels of a plan's picture see nothing but what has the material of a triangle, such as the
// box: where it glows all of the pixel does.
inline std::vector<bool> seen_of(Scene scene, const Camera& camera, std::size_t triangle = 24) {
    scene.lights.clear();
    for (Material& material : scene.materials) material.base_color = glm::vec4(0, 0, 0, 1);
    scene.materials[scene.triangles[triangle].material].emission = glm::vec3(1.0f);
    std::vector<bool> out;
    for (const glm::vec3& pixel : traced(scene, camera, 64)) out.push_back(pixel.x > 0.999f);
    return out;
}

}  // namespace clgi::test
