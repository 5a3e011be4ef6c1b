// Which emissive triangles are one lamp.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// [triangles] the lamp of each, numbered as they first appear: triangles that hang together by
// corners that coincide (weld).
std::vector<std::uint32_t> lamps_of(const std::vector<std::array<glm::vec3, 3>>& triangles);

}  // namespace clgi
