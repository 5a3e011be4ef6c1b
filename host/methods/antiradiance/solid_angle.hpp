// The solid angle of a triangle.
// [Van Oosterom, Strackee: The Solid Angle of a Plane Triangle. IEEE Transactions on Biomedical
// Engineering 30, 1983]
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace clgi {

// Of heights above a sender, as a share of its radius: below it rounding chooses the side.
constexpr double height_rounding = 1e-12;

// sr, 0 to 2 pi, from `eye`; the same from both sides. 0 from a corner and from the triangle's
// plane outside it; within it rounding decides for 0 or 2 pi.
inline double solid_angle(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& eye) {
    glm::dvec3 to[3];
    for (int k = 0; k < 3; ++k) {
        to[k] = corners[k] - eye;
        const double length = glm::length(to[k]);
        if (!(length > 0.0)) return 0.0;
        to[k] /= length;
    }
    const double volume = std::abs(glm::dot(to[0], glm::cross(to[1], to[2])));
    return 2.0 * std::atan2(volume, 1.0 + glm::dot(to[0], to[1]) + glm::dot(to[1], to[2]) +
                                        glm::dot(to[2], to[0]));
}

// The same with the sign of the side: positive where the corners run counter-clockwise.
inline double signed_solid_angle(const std::array<glm::dvec3, 3>& p, const glm::dvec3& eye) {
    const double angle = solid_angle(p, eye);
    return glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), eye - p[0]) < 0.0 ? -angle : angle;
}

}  // namespace clgi
