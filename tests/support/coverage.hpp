// What pixels show of a polygon, exactly.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scenes.hpp"

namespace clgi::test {

// The part of each pixel that a convex polygon covers; counter-clockwise, y up from the bottom row.
inline std::vector<double> coverage(const std::vector<glm::dvec2>& polygon, int width, int height) {
    std::vector<double> out;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            std::vector<glm::dvec2> rest = polygon;
            const double low[2] = {double(column), double(height - 1 - row)};
            for (int side = 0; side < 4; ++side) {
                const int axis = side / 2;
                const double sign = side % 2 ? -1.0 : 1.0,
                             limit = side % 2 ? low[axis] + 1.0 : low[axis];
                std::vector<glm::dvec2> kept;
                for (std::size_t i = 0; i < rest.size(); ++i) {
                    const glm::dvec2 a = rest[i], b = rest[(i + 1) % rest.size()];
                    const double da = sign * (a[axis] - limit), db = sign * (b[axis] - limit);
                    if (da >= 0.0) kept.push_back(a);
                    if ((da >= 0.0) != (db >= 0.0)) kept.push_back(a + (b - a) * (da / (da - db)));
                }
                rest = kept;
            }
            double area = 0.0;
            for (std::size_t i = 0; i < rest.size(); ++i) {
                const glm::dvec2 a = rest[i], b = rest[(i + 1) % rest.size()];
                area += 0.5 * (a.x * b.y - a.y * b.x);
            }
            out.push_back(area);
        }
    return out;
}

// Seen by pixel_camera(): a quadrangle that emits, as an outline.
inline Scene glowing_quad(const std::vector<glm::dvec2>& corners, const glm::vec3& radiance) {
    Scene scene = plain_scene(glm::vec3(0.0f));
    scene.materials[0].emission = radiance;
    const auto corner = [&](std::size_t k) {
        return glm::dvec3(corners[k].x, corners[k].y, k % 3 ? 3.0 : 0.0);
    };
    add_quad(scene, {corner(0), corner(1), corner(2), corner(3)});
    return scene;
}

}  // namespace clgi::test
