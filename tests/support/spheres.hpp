// Spheres of many triangles that share their vertices.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/procedural.hpp>
#include <utility>

#include "scenes.hpp"

namespace clgi::test {

// 20 * 4^subdivisions triangles and 2 + 10 * 4^subdivisions vertices; facing 1: outward, -1:
// inward.
inline void add_sphere(Scene& scene, const glm::dvec3& centre, double radius, int subdivisions,
                       int facing, std::uint32_t material = 0) {
    const Scene sphere = furnace({.subdivisions = subdivisions, .radius = radius});
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const glm::dvec3& position : sphere.positions) {
        scene.positions.push_back(centre + position);
        scene.normals.push_back(static_cast<float>(facing) * glm::vec3(glm::normalize(position)));
    }
    for (SceneTriangle triangle : sphere.triangles) {
        for (std::uint32_t& vertex : triangle.vertex) vertex += first;
        if (facing > 0) std::swap(triangle.vertex[1], triangle.vertex[2]);
        triangle.material = material;
        scene.triangles.push_back(triangle);
    }
}

// A square [0, 1]^2 of 2 n^2 triangles that share their vertices; height(x, z) above y = 0.
template <typename Height>
void add_sheet(Scene& scene, int n, const Height& height) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const auto row = static_cast<std::uint32_t>(n + 1);
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k) {
            const double x = static_cast<double>(i) / n, z = static_cast<double>(k) / n;
            scene.positions.emplace_back(x, height(x, z), z);
            scene.normals.emplace_back(0.0f, 1.0f, 0.0f);
        }
    for (std::uint32_t i = 0; i + 1 < row; ++i)
        for (std::uint32_t k = 0; k + 1 < row; ++k) {
            const std::uint32_t a = first + i * row + k;
            scene.triangles.push_back({{a, a + 1, a + row + 1}, 0});
            scene.triangles.push_back({{a, a + row + 1, a + row}, 0});
        }
}

}  // namespace clgi::test
