// What an effect costs that is on, and scenes that do not call for it.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "device.hpp"
#include "scenes.hpp"

namespace clgi::test {

// What was built, enqueued and allocated.
struct Cost {
    std::vector<std::string> kernels, passes;
    std::size_t bytes = 0;

    std::size_t built(const std::string& words) const { return count(kernels, words); }
    std::size_t enqueued(const std::string& words) const { return count(passes, words); }
    void add(const std::vector<PassEvent>& events) {
        for (const PassEvent& pass : events) passes.push_back(pass.name);
    }

private:
    static std::size_t count(const std::vector<std::string>& names, const std::string& words) {
        return static_cast<std::size_t>(std::count_if(
            names.begin(), names.end(),
            [&](const std::string& name) { return name.find(words) != std::string::npos; }));
    }
};

// Kernels of its own, so that it is known what was built.
inline Programs own_programs() { return {device().context, device().device}; }

// All kinds of light in colours of their own, in a room that nothing stands in. One of its crooked
// walls may be open, for the sun: walls block it from behind as well.
inline Scene convex_room(bool open = true) {
    Scene scene = plain_scene({0.7f, 0.6f, 0.5f});
    Material lamp;
    lamp.base_color = {0.3f, 0.2f, 0.5f, 1.0f};
    lamp.emission = {4.0f, 3.0f, 6.0f};
    const std::uint32_t shines = add_material(scene, lamp);
    const glm::dvec3 a(-1.7, -1.1, 1.4), b(2.1, -0.8, 1.2), c(0.2, -1.3, -1.9), d(0.1, 2.0, 0.3);
    const auto add = [&](const glm::dvec3& p, const glm::dvec3& q, const glm::dvec3& r,
                         std::uint32_t material) {
        const bool inward =
            glm::dot(glm::cross(q - p, r - p), glm::dvec3(0.2, -0.3, 0.2) - p) > 0.0;
        add_triangle(scene, p, inward ? q : r, inward ? r : q, material);
    };
    add(a, b, c, 0);
    add(a, d, b, 0);
    if (!open) add(b, d, c, 0);
    add(c, d, a, shines);
    scene.lights = {point_light({0.1, 0.4, 0.3}),
                    spot_light({0.3, 0.2, 0.2}, {-0.4f, -1.0f, 0.1f}, 0.6),
                    spot_light({-0.2, 0.1, 0.4}, {0.9f, -0.5f, -0.3f}, 1.3),
                    directional_light(glm::vec3(glm::cross(b - c, d - c)))};
    const glm::vec3 colours[] = {{3, 2, 1}, {4, 9, 2}, {1, 2, 5}, {0.5f, 2, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
        scene.lights[i].intensity = colours[i];
        if (scene.lights[i].kind == Light::Kind::spot) scene.lights[i].inner_angle = 0.3f;
    }
    scene.cameras = {camera_at({0.5, -0.2, 0.6}, {-0.3, -0.6, -0.5}, 1.2f)};
    return scene;
}

// A point light, a spot and the sun over a tilted floor, and a plate between them.
inline Scene shaded_floor() {
    Scene scene = plain_scene({0.8f, 0.6f, 0.4f});
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.2, 1, 0.1));
    const glm::dvec3 u = glm::normalize(glm::cross(n, glm::dvec3(0, 0, 1))), v = glm::cross(n, u);
    add_quad(scene, {-2.0 * u - 2.0 * v, 2.0 * u - 2.0 * v, 2.0 * u + 2.0 * v, 2.0 * v - 2.0 * u});
    if (glm::dot(glm::dvec3(scene.normals[0]), n) < 0.0) {
        for (SceneTriangle& t : scene.triangles) std::swap(t.vertex[1], t.vertex[2]);
        for (glm::vec3& normal : scene.normals) normal = -normal;
    }
    Material both;
    both.double_sided = true;
    const std::uint32_t plate = add_material(scene, both);
    add_floor(scene, 0.8, 1.0, plate);
    scene.lights = {point_light({0.2, 2.1, -0.1}),
                    spot_light({-0.3, 2.4, 0.2}, {0.1f, -1.0f, 0.0f}, 0.7),
                    directional_light({0.2f, -1.0f, -0.3f})};
    scene.lights[0].intensity = {9.0f, 5.0f, 3.0f};
    scene.lights[1].intensity = {2.0f, 8.0f, 4.0f};
    scene.lights[2].intensity = {0.3f, 0.5f, 0.9f};
    scene.cameras = {camera_at({0.4, 0.55, 1.9}, {0.0, 0.0, -0.2}, 0.7f)};
    return scene;
}

inline EmitterOptions small_maps(bool shadows) {
    EmitterOptions out;
    out.shadow_size = 128;
    out.face_size = 128;
    out.area_samples = 6;
    out.shadows = shadows;
    return out;
}

// Beside an edge of the convex room texels of shadow maps show the other face.
inline bool near_an_edge(const Scene& room, const glm::dvec3& at, double distance) {
    int faces = 0;
    for (const SceneTriangle& t : room.triangles) {
        const glm::dvec3 n(room.normals[t.vertex[0]]);
        faces += std::abs(glm::dot(n, at - room.positions[t.vertex[0]])) < distance;
    }
    return faces > 1;
}

// Shadow maps take light away where nothing lies between, at edges: so little, and nowhere more
// than is there.
inline void expect_no_less(const std::vector<glm::vec3>& with,
                           const std::vector<glm::vec3>& without, double share) {
    ASSERT_EQ(with.size(), without.size());
    double sum = 0.0, apart = 0.0;
    for (std::size_t i = 0; i < with.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            sum += double{without[i][c]};
            apart += double{without[i][c]} - double{with[i][c]};
            EXPECT_GE(without[i][c], with[i][c] * (1.0f - 1e-5f)) << i << ", channel " << c;
        }
    EXPECT_GT(sum, 10.0);
    EXPECT_LT(apart, share * sum);
}

}  // namespace clgi::test
