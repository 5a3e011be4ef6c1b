// Which of a few sites each of many points belongs to.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// [points] the nearest site, of equally near ones the first. A site that is nearest to no point
// gets the nearest one of those whose site has more. Fast where neighbouring points are near each
// other in the list. 1 <= sites <= points.
std::vector<std::uint32_t> nearest_sites(const std::vector<glm::dvec3>& points,
                                         const std::vector<glm::dvec3>& sites);

}  // namespace clgi
