// Puts triangles that are near each other in space near each other in memory.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

struct SpatialOrder {
    std::vector<std::uint32_t> triangles;  // scene index of each device triangle
    std::vector<std::uint32_t> vertices;  // scene index of each device vertex; unused ones left out
    std::vector<std::uint32_t> renumbered;  // device index of each scene vertex that is used
};

// Where a triangle lies on a Z-order curve, for emissive ones alone. Corners in the local frame.
std::uint32_t place_on_curve(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

// Triangles so that every cluster, and every part of one, has triangles that are close together:
// they are divided at the centre of the box around the middles of their boxes, across its longest
// axis, at whole clusters and then at whole parts. In a part they have scene order. Vertices in the
// order of their first use. local: positions with coordinates in [-1, 1].
SpatialOrder spatial_order(const std::vector<glm::vec4>& local,
                           const std::vector<SceneTriangle>& triangles);

}  // namespace clgi
