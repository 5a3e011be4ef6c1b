// A patch as a part of its triangle of the scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/elements.hpp>

namespace clgi {

// Of each corner of a patch: weights of the second and vertex patch corner of its triangle.
using PatchWeights = std::array<glm::dvec2, 3>;

inline std::array<glm::dvec3, 3> triangle_corners(const SceneTriangle& triangle,
                                                  const std::vector<glm::dvec3>& positions) {
    return {positions[triangle.vertex[0]], positions[triangle.vertex[1]],
            positions[triangle.vertex[2]]};
}

// scene: what the tree was made from.
inline PatchWeights patch_weights(const ElementTree& tree, std::size_t patch, const Scene& scene) {
    const auto p = triangle_corners(scene.triangles[tree.triangles[patch]], scene.positions);
    const glm::dvec3 edge1 = p[1] - p[0], edge2 = p[2] - p[0];
    const glm::dvec3 normal = glm::cross(edge1, edge2);
    const double scale = 1.0 / glm::dot(normal, normal);
    PatchWeights out;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 to = tree.corners[patch][k] - p[0];
        out[k] = {scale * glm::dot(glm::cross(to, edge2), normal),
                  scale * glm::dot(glm::cross(edge1, to), normal)};
    }
    return out;
}

// Of the patch, as a share of the triangle's; below 0 where it is wound against the triangle.
inline double signed_share(const PatchWeights& w) {
    const glm::dvec2 edge1 = w[1] - w[0], edge2 = w[2] - w[0];
    return edge1.x * edge2.y - edge1.y * edge2.x;
}

}  // namespace clgi
