// Normals on the host: of unit length or zero, and what an affine map does to them.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace clgi {

// Scaled first, so that a model in nanometres does not underflow.
inline glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    if (!(largest > 0.0) || !std::isfinite(largest)) return glm::dvec3(0.0);
    return glm::normalize(v / largest);
}

// The inverse transpose, but for a factor above 0: cofactors are right also where a scale is zero.
inline glm::dmat3 normal_matrix(const glm::dmat3& linear) {
    return glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                      glm::cross(linear[0], linear[1])) *
           (glm::determinant(linear) < 0.0 ? -1.0 : 1.0);
}

}  // namespace clgi
