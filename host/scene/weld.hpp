// Vertices that coincide within the rounding of floats.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

// [positions] the welded vertex of each, numbered as they first appear; rule in
// clgi/advanced/adjacency.hpp.
std::vector<std::uint32_t> weld(const std::vector<glm::dvec3>& positions,
                                const std::vector<SceneTriangle>& triangles);

}  // namespace clgi
