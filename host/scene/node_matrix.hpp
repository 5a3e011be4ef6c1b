// The matrix of a node, and where something stands that a node carries. glTF 2.0, section 3.5.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace clgi {

inline bool is_rotation(const glm::dquat& q) {
    return glm::length(q) > 1e-6 && glm::length(q) < 1e6;
}

// translation * rotation * scale. What is no rotation turns nothing.
inline glm::dmat4 node_matrix(const glm::dvec3& translation, const glm::dquat& q,
                              const glm::dvec3& scale) {
    glm::dmat4 transform(1.0);
    if (is_rotation(q)) transform = glm::mat4_cast(q / glm::length(q));
    for (int column = 0; column < 3; ++column) transform[column] *= scale[column];
    transform[3] = glm::dvec4(translation, 1.0);
    return transform;
}

// Where a node stands and where it looks, along its -Z. Zero: it has no such direction.
struct NodePlace {
    explicit NodePlace(const glm::dmat4& matrix)
        : position(matrix[3]),
          forward(-unit_or_zero(matrix[2], 1e-30)),
          right(unit_or_zero(glm::cross(forward, unit_or_zero(matrix[1], 1e-30)), 1e-9)) {}

    // False for numbers that are not finite.
    bool is_usable(const glm::dvec3& direction) const {
        return glm::length(position) <= 1e18 && direction != glm::dvec3(0.0);
    }

    glm::dvec3 position;
    glm::dvec3 forward;
    glm::dvec3 right;

private:
    // Zero for numbers that are not finite as well. Above 1e150 squares overflow.
    static glm::dvec3 unit_or_zero(const glm::dvec3& v, double least) {
        const double length = glm::length(v);
        return length > least && length <= 1e150 ? v / length : glm::dvec3(0.0);
    }
};

}  // namespace clgi
