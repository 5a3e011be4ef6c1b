// SPDX-License-Identifier: MIT
#include "scene/lamps.hpp"

#include "scene/disjoint_sets.hpp"
#include "scene/weld.hpp"

namespace clgi {

std::vector<std::uint32_t> lamps_of(const std::vector<std::array<glm::vec3, 3>>& triangles) {
    std::vector<glm::dvec3> corners;
    std::vector<SceneTriangle> of_corners(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            of_corners[t].vertex[k] = static_cast<std::uint32_t>(corners.size());
            corners.emplace_back(triangles[t][k]);
        }
    const std::vector<std::uint32_t> welded = weld(corners, of_corners);
    DisjointSets sets(triangles.size());
    std::vector<std::uint32_t> first(corners.size(), static_cast<std::uint32_t>(triangles.size()));
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (const std::uint32_t corner : of_corners[t].vertex) {
            std::uint32_t& of = first[welded[corner]];
            if (of < triangles.size())
                sets.join(of, t);
            else
                of = t;
        }
    return sets.numbered();
}

}  // namespace clgi
