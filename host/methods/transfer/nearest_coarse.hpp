// Which triangle of a coarse mesh stands for each triangle of the fine one.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// [fine] the coarse triangle that is nearest to the centre, of those of the same piece, and if
// there are any of those that face the same way: the other side of a thin sheet is as near.
// 0xffffffff where the piece has no coarse triangle. pieces: [positions]. Coarse triangles that
// follow each other should be near each other.
std::vector<std::uint32_t> nearest_coarse(const std::vector<glm::dvec3>& positions,
                                          const std::vector<std::uint32_t>& pieces,
                                          const std::vector<glm::uvec3>& fine,
                                          const std::vector<glm::uvec3>& coarse);

}  // namespace clgi
