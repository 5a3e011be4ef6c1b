// What holds for any tree of elements with leaves at vertices.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <clgi/advanced/elements.hpp>
#include <set>

#include "scenes.hpp"

namespace clgi::test {

// Returns how many leaves at vertices it has.
inline std::size_t expect_consistent(const ElementTree& tree, bool joined = false) {
    if (tree.first_patches.empty()) return 0;
    EXPECT_EQ(tree.first_patches.size(), tree.count() + 1);
    EXPECT_EQ(tree.first_patches.back(), tree.vertex_patches.size());
    std::size_t found = 0;
    std::set<std::array<std::uint32_t, 3>> used;  // triangle, corner, side
    for (std::size_t i = 0; i < tree.count(); ++i) {
        SCOPED_TRACE(i);
        double farthest = 0.0;
        for (std::size_t k = i; k < tree.ends[i]; ++k)
            for (std::uint32_t t = tree.first_patches[k]; t < tree.first_patches[k + 1]; ++t) {
                const auto& p = tree.vertex_patches[t].corners;
                for (const glm::dvec3& at :
                     {p[0], 0.5 * (p[0] + p[1]), 0.5 * (p[0] + p[2]), (p[0] + p[1] + p[2]) / 3.0})
                    farthest = std::max(farthest, glm::length(at - tree.positions[i]));
            }
        EXPECT_LE(farthest, tree.radii[i] * (1 + 1e-12));
        if (!tree.is_vertex(i)) continue;
        ++found;
        EXPECT_TRUE(tree.is_leaf(i) && !tree.is_patch(i) && tree.is_flat(i));
        EXPECT_NEAR(farthest, tree.radii[i], 1e-12 * farthest);
        glm::dvec3 across(0.0);
        double area = 0.0;
        for (std::uint32_t t = tree.first_patches[i]; t < tree.first_patches[i + 1]; ++t) {
            const VertexPatch& vertex_patch = tree.vertex_patches[t];
            EXPECT_TRUE(
                used.insert({vertex_patch.triangle, vertex_patch.corner, tree.backs[i]}).second);
            if (!joined) {
                EXPECT_EQ(vertex_patch.corners[0],
                          tree.vertex_patches[tree.first_patches[i]].corners[0]);
            }
            const auto& p = vertex_patch.corners;
            across += glm::cross(p[1] - p[0], p[2] - p[0]) / 6.0;
            area += glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / 6.0;
        }
        EXPECT_NEAR(tree.areas[i], area, 1e-12 * area);
        EXPECT_LE(glm::length(glm::normalize(across) - tree.normals[i]), 1e-9);
    }
    EXPECT_EQ(used.size(), tree.vertex_patches.size());
    return found;
}

inline double area_of(const Scene& scene) {
    double sum = 0.0;
    for (const SceneTriangle& t : scene.triangles) {
        const glm::dvec3& a = scene.positions[t.vertex[0]];
        sum += 0.5 * glm::length(glm::cross(scene.positions[t.vertex[1]] - a,
                                            scene.positions[t.vertex[2]] - a));
    }
    return sum;
}

}  // namespace clgi::test
