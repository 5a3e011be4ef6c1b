// Whether triangles of one plane cover a common part of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/local_triangles.hpp"

namespace clgi {

// chosen: indices of triangles that lie in a plane of this normal to within same_place. Parts that
// are not wider than same_place do not count. Compares `tests_left` pairs at most and takes what it
// compared away; true also if they were not enough.
bool triangles_overlap(const std::vector<LocalTriangle>& triangles,
                       const std::vector<std::uint32_t>& chosen, const glm::dvec3& normal,
                       std::size_t& tests_left);

}  // namespace clgi
