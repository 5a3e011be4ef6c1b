// SPDX-License-Identifier: MIT
#include "scene/locality.hpp"

#include <algorithm>
#include <numeric>

namespace clgi {
namespace {

// Every third bit of the result holds a bit of the 10-bit value.
std::uint32_t spread_bits(std::uint32_t value) {
    value = (value | value << 16) & 0x030000ffu;
    value = (value | value << 8) & 0x0300f00fu;
    value = (value | value << 4) & 0x030c30c3u;
    return (value | value << 2) & 0x09249249u;
}

std::uint32_t z_order(const glm::vec3& point) {
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float cell = std::clamp((point[axis] + 1.0f) * 512.0f, 0.0f, 1023.0f);
        code |= spread_bits(static_cast<std::uint32_t>(cell)) << axis;
    }
    return code;
}

}  // namespace

std::uint32_t place_on_curve(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    return z_order((a + b + c) / 3.0f);
}

SpatialOrder spatial_order(const std::vector<glm::vec4>& local,
                           const std::vector<SceneTriangle>& triangles) {
    std::vector<std::uint32_t> codes;
    codes.reserve(triangles.size());
    for (const SceneTriangle& t : triangles)
        codes.push_back(place_on_curve(glm::vec3(local[t.vertex[0]]), glm::vec3(local[t.vertex[1]]),
                                       glm::vec3(local[t.vertex[2]])));
    SpatialOrder order;
    order.triangles.resize(triangles.size());
    std::iota(order.triangles.begin(), order.triangles.end(), 0u);
    std::stable_sort(order.triangles.begin(), order.triangles.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });

    constexpr std::uint32_t unused = 0xffffffffu;
    order.renumbered.assign(local.size(), unused);
    for (const std::uint32_t triangle : order.triangles)
        for (const std::uint32_t vertex : triangles[triangle].vertex)
            if (order.renumbered[vertex] == unused) {
                order.renumbered[vertex] = static_cast<std::uint32_t>(order.vertices.size());
                order.vertices.push_back(vertex);
            }
    return order;
}

}  // namespace clgi
