// Small pieces of surface that nothing connects, put together by direction and place.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

struct Island {
    std::uint32_t id;
    double area;        // m^2
    glm::dvec3 centre;  // metres
    glm::dvec3 normal;  // any length
    bool double_sided;  // counts twice
};

// Ids of the islands, by cluster. The axis nearest to their normals is the same within a cluster,
// so is double_sided. At most `room` clusters, or one for each of these kinds that occurs. The
// cluster with the largest spread is cut first: across its longest side, where half of its area
// lies on either side.
std::vector<std::vector<std::uint32_t>> cluster_islands(const std::vector<Island>& islands,
                                                        std::int64_t room);

}  // namespace clgi
