// Plain geometry of a scene's triangles, for tests that ask whether surfaces close.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <clgi/scene.hpp>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <utility>
#include <vector>

namespace geometry {

inline glm::dvec3 corner(const clgi::Scene& scene, std::size_t triangle, int k) {
    return scene.positions[scene.triangles[triangle].vertex[k]];
}

inline glm::dvec3 doubled_area(const clgi::Scene& scene, std::size_t triangle) {
    const glm::dvec3 a = corner(scene, triangle, 0);
    return glm::cross(corner(scene, triangle, 1) - a, corner(scene, triangle, 2) - a);
}

inline double area(const clgi::Scene& scene) {
    double sum = 0.0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        sum += 0.5 * glm::length(doubled_area(scene, t));
    }
    return sum;
}

// Signed: positive when the faces look outward.
inline double volume(const clgi::Scene& scene, std::size_t first, std::size_t count) {
    double sum = 0.0;
    for (std::size_t t = first; t < first + count; ++t) {
        sum += glm::dot(corner(scene, t, 0), doubled_area(scene, t)) / 6.0;
    }
    return sum;
}

using Point = std::array<double, 3>;
using Edge = std::pair<Point, Point>;

// Directed edges, by position, that no triangle of the chosen parts runs the other way. Ends are
// rounded to 1e-9: faces meet where they were computed to, but -0 is not 0 to a map.
inline std::vector<Edge> open_edges(const clgi::Scene& scene,
                                    const std::function<bool(const clgi::Part&)>& chosen) {
    const auto key = [&](std::uint32_t vertex) {
        const glm::dvec3 p = glm::round(scene.positions[vertex] * 1e9) + 0.0;
        return Point{p.x, p.y, p.z};
    };
    std::map<Edge, int> balance;
    for (const clgi::Part& part : scene.parts) {
        if (!chosen(part)) continue;
        for (std::uint32_t t = 0; t < part.triangle_count; ++t) {
            const auto& vertex = scene.triangles[part.first_triangle + t].vertex;
            for (int k = 0; k < 3; ++k) {
                const Point from = key(vertex[k]), to = key(vertex[(k + 1) % 3]);
                ++balance[{from, to}];
                --balance[{to, from}];
            }
        }
    }
    std::vector<Edge> open;
    for (const auto& [edge, count] : balance) {
        if (count > 0) open.push_back(edge);
    }
    return open;
}

inline bool any_part(const clgi::Part&) { return true; }

// Distance to the first face that a ray meets; infinite when it meets none.
inline double first_hit(const clgi::Scene& scene, const glm::dvec3& origin,
                        const glm::dvec3& direction) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::dvec3 a = corner(scene, t, 0);
        const glm::dvec3 u = corner(scene, t, 1) - a, v = corner(scene, t, 2) - a;
        const glm::dvec3 p = glm::cross(direction, v);
        const double determinant = glm::dot(u, p);
        if (determinant == 0.0) continue;
        const double s = glm::dot(origin - a, p) / determinant;
        const glm::dvec3 q = glm::cross(origin - a, u);
        const double r = glm::dot(direction, q) / determinant;
        const double distance = glm::dot(v, q) / determinant;
        if (s < 0.0 || r < 0.0 || s + r > 1.0 || distance < 1e-9) continue;
        nearest = std::min(nearest, distance);
    }
    return nearest;
}

}  // namespace geometry
