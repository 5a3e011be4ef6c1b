// Triangles in a plane that lie on each other.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

namespace clgi {

// Pairs of overlapping triangles, the smaller index first, rising. corners: [3 * triangles]
// counter-clockwise. An overlap not deeper than `slack` does not count: neighbours touch.
std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(
    const std::vector<glm::dvec2>& corners, double slack);

}  // namespace clgi
