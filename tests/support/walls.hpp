// Surfaces for patches and VPLs: walls cut into many triangles, and what every patch must fulfil.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/scene.hpp>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "scenes.hpp"

namespace clgi::test {

// A rectangle in the plane z = 0 of cells * cells crooked cells of two triangles each, cut along
// either diagonal.
inline Scene crooked_wall(double width, double height, std::uint32_t cells) {
    Scene scene = plain_scene();
    Random random(3);
    for (std::uint32_t j = 0; j <= cells; ++j)
        for (std::uint32_t i = 0; i <= cells; ++i) {
            double x = i, y = j;
            if (i > 0 && i < cells) x += random(-0.2, 0.2);
            if (j > 0 && j < cells) y += random(-0.2, 0.2);
            scene.positions.emplace_back(x * width / cells, y * height / cells, 0.0);
            scene.normals.emplace_back(0, 0, 1);
        }
    for (std::uint32_t j = 0; j < cells; ++j)
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i, b = a + 1, c = b + cells + 1, d = c - 1;
            if (random.integer(0, 1) == 0) {
                scene.triangles.push_back({{a, b, c}, 0});
                scene.triangles.push_back({{a, c, d}, 0});
            } else {
                scene.triangles.push_back({{a, b, d}, 0});
                scene.triangles.push_back({{b, c, d}, 0});
            }
        }
    return scene;
}

inline glm::dvec3 corner(const Scene& scene, std::uint32_t triangle, int k) {
    return scene.positions[scene.triangles[triangle].vertex[k]];
}

// Twice the area long.
inline glm::dvec3 normal_of(const Scene& scene, std::uint32_t triangle) {
    const glm::dvec3 a = corner(scene, triangle, 0);
    return glm::cross(corner(scene, triangle, 1) - a, corner(scene, triangle, 2) - a);
}

inline double area_of(const Scene& scene, std::uint32_t triangle) {
    return 0.5 * glm::length(normal_of(scene, triangle));
}

inline double area_of(const Scene& scene) {
    double sum = 0.0;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) sum += area_of(scene, t);
    return sum;
}

inline Scene moved(Scene scene, const glm::dvec3& by) {
    for (glm::dvec3& p : scene.positions) p += by;
    return scene;
}

// Of a VPL or sample, metres.
template <typename Point>
glm::dvec3 position(const Scene& scene, const Point& p) {
    const glm::dvec3 a = corner(scene, p.triangle, 0);
    return a + double{p.b1} * (corner(scene, p.triangle, 1) - a) +
           double{p.b2} * (corner(scene, p.triangle, 2) - a);
}

template <typename Point>
std::vector<glm::dvec3> positions(const Scene& scene, const std::vector<Point>& points) {
    std::vector<glm::dvec3> out;
    for (const Point& p : points) out.push_back(position(scene, p));
    return out;
}

// In units of the mean spacing sqrt(area / points).
inline double least_distance(const std::vector<glm::dvec3>& points, double area) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            least = std::min(least, glm::length(points[i] - points[j]));
    return least / std::sqrt(area / double(points.size()));
}

}  // namespace clgi::test
