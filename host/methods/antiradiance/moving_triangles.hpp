// Which triangles of a scene move, and where they are.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/elements.hpp>
#include <cstdint>
#include <vector>

#include "methods/antiradiance/faces.hpp"

namespace clgi {

// [triangles] 1: a corner is in some pose further from its place in the scene than floats could
// tell; empty where none is. Throws Error for poses of another number of vertices, InputError for
// positions that are not finite.
std::vector<std::uint8_t> moving_triangles(const Scene& scene, const VertexPoses& poses);

// [faces] in a pose.
std::vector<glm::dvec3> centroids(const std::vector<Face>& faces, const Scene& scene,
                                  const std::vector<glm::dvec3>& positions);

}  // namespace clgi
