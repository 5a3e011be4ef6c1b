// How triangles are cut in two. [derived: the longest edge keeps parts from becoming slivers]
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace clgi {

// The longest edge k lies between corners k and k + 1; the first of several.
inline std::uint32_t longest_edge(const std::array<glm::dvec3, 3>& p) {
    std::uint32_t longest = 0;
    double most = 0.0;
    for (std::uint32_t k = 0; k < 3; ++k) {
        const glm::dvec3 edge = p[(k + 1) % 3] - p[k];
        if (glm::dot(edge, edge) > most) {
            most = glm::dot(edge, edge);
            longest = k;
        }
    }
    return longest;
}

// The two halves on either side of the middle of the longest edge, wound as before.
inline std::array<std::array<glm::dvec3, 3>, 2> halve(const std::array<glm::dvec3, 3>& p) {
    const std::uint32_t k = longest_edge(p);
    const glm::dvec3 &a = p[k], &b = p[(k + 1) % 3], &apex = p[(k + 2) % 3];
    const glm::dvec3 middle = a + 0.5 * (b - a);
    return {{{apex, a, middle}, {apex, middle, b}}};
}

}  // namespace clgi
