// Directions about a normal.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace clgi {

// A unit vector about n, its density in proportion to the cosine. [Malley's method]
inline glm::dvec3 about(const glm::dvec3& n, double u, double v) {
    const glm::dvec3 helper =
        std::abs(n.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 right = glm::normalize(glm::cross(n, helper));
    const glm::dvec3 up = glm::cross(n, right);
    const double radius = std::sqrt(u), angle = 2.0 * std::numbers::pi * v;
    return radius * std::cos(angle) * right + radius * std::sin(angle) * up +
           std::sqrt(1.0 - u) * n;
}

}  // namespace clgi
