// SPDX-License-Identifier: MIT
#include "scene/clusters.hpp"

#include <algorithm>
#include <cmath>

namespace clgi {
namespace {

constexpr float least_cosine = 0.1f;  // a wider cone is hardly ever seen from behind as a whole

glm::vec4 cone_of(const std::vector<glm::uvec4>& triangles, const std::vector<glm::vec4>& positions,
                  std::size_t first, std::size_t last) {
    const auto normal = [&](std::size_t t) {
        const glm::vec3 a(positions[triangles[t].x]);
        return glm::cross(glm::vec3(positions[triangles[t].y]) - a,
                          glm::vec3(positions[triangles[t].z]) - a);
    };
    glm::vec3 axis(0.0f);
    for (std::size_t t = first; t < last; ++t) {
        if (triangles[t].w & static_cast<std::uint32_t>(TRIANGLE_DOUBLE_SIDED))
            return glm::vec4(0.0f, 0.0f, 0.0f, 2.0f);
        const glm::vec3 n = normal(t);
        const float length = std::sqrt(glm::dot(n, n));
        if (length > 0.0f) axis += n / length;
    }
    const float whole = std::sqrt(glm::dot(axis, axis));
    if (!(whole > 0.0f)) return glm::vec4(0.0f, 0.0f, 0.0f, 2.0f);
    axis /= whole;
    float cosine = 1.0f;
    for (std::size_t t = first; t < last; ++t) {
        const glm::vec3 n = normal(t);
        const float length = std::sqrt(glm::dot(n, n));
        if (length > 0.0f) cosine = std::min(cosine, glm::dot(n, axis) / length);
    }
    if (!(cosine > least_cosine)) return glm::vec4(0.0f, 0.0f, 0.0f, 2.0f);
    return glm::vec4(axis, std::sqrt(1.0f - cosine * cosine));
}

}  // namespace

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
        out.push_back({glm::vec4(low, 0.0f), glm::vec4(high, 0.0f),
                       cone_of(triangles, positions, first, last)});
    }
    return out;
}

}  // namespace clgi
