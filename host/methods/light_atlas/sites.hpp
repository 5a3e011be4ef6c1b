// Which of a few sites each of many points belongs to.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// [points] the nearest site, of equally near ones the first. A site that is nearest to no point
// gets the nearest one of those whose site has more. Fast where neighbouring points are near each
// other in the list. 1 <= sites <= points.
//
// divided: whether something stands between a point and a site. A point then belongs to the nearest
// site without, if there is one among the 16 nearest.
std::vector<std::uint32_t> nearest_sites(
    const std::vector<glm::dvec3>& points, const std::vector<glm::dvec3>& sites,
    const std::function<bool(std::uint32_t point, std::uint32_t site)>& divided = nullptr);

}  // namespace clgi
