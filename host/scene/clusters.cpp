// SPDX-License-Identifier: MIT
#include "scene/clusters.hpp"

#include <algorithm>

namespace clgi {

std::vector<Cluster> make_clusters(const std::vector<glm::uvec4>& triangles,
                                   const std::vector<glm::vec4>& positions) {
    std::vector<Cluster> out;
    for (std::size_t first = 0; first < triangles.size(); first += CLUSTER_TRIANGLES) {
        const std::size_t last = std::min<std::size_t>(first + CLUSTER_TRIANGLES, triangles.size());
        glm::vec3 low(positions[triangles[first].x]), high = low;
        for (std::size_t t = first; t < last; ++t)
            for (int k = 0; k < 3; ++k) {
                const glm::vec4& p = positions[triangles[t][k]];
                for (int axis = 0; axis < 3; ++axis) {
                    // Of 0 and -0 the first one stays, here and on the device.
                    if (p[axis] < low[axis]) low[axis] = p[axis];
                    if (p[axis] > high[axis]) high[axis] = p[axis];
                }
            }
        out.push_back({glm::vec4(low, 0.0f), glm::vec4(high, 0.0f)});
    }
    return out;
}

}  // namespace clgi
