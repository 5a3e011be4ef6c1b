// SPDX-License-Identifier: MIT
#include "methods/antiradiance/leaf_vertices.hpp"

#include "methods/antiradiance/joined_shares.hpp"
#include "scene/weld.hpp"

namespace clgi {
namespace {

constexpr double one_surface = 0.9;  // cosine between the normals of leaves that share a vertex

}  // namespace

LeafVertices leaf_vertices(const ElementTree& tree, const std::vector<std::uint32_t>& rows) {
    std::vector<glm::dvec3> corners;
    std::vector<SceneTriangle> triangles;
    for (const std::uint32_t i : rows) {
        if (tree.is_vertex(i)) continue;
        const auto first = static_cast<std::uint32_t>(corners.size());
        corners.insert(corners.end(), tree.corners[i].begin(), tree.corners[i].end());
        triangles.push_back({{first, first + 1, first + 2}, 0});
    }
    const std::vector<std::uint32_t> places = weld(corners, triangles);

    // Of each place, the vertices there: the first leaf of each says which way it faces.
    std::vector<std::vector<std::uint32_t>> at_place(corners.size());
    std::vector<glm::dvec3> normals;
    std::vector<LeafShares> weights;  // of each vertex: rows, and how much of the light is theirs
    LeafVertices out;
    out.vertices.resize(rows.size());
    out.of_vertex_patches.assign(tree.vertex_patches.size(), no_index);
    const JoinedShares joined(tree, rows);
    std::size_t corner = 0;
    for (std::uint32_t row = 0; row < rows.size(); ++row) {
        if (tree.is_vertex(rows[row])) {
            const std::uint32_t first = tree.first_patches[rows[row]];
            for (std::uint32_t k = first; k < tree.first_patches[rows[row] + 1]; ++k) {
                const glm::dvec3& at = tree.vertex_patches[k].corners[0];
                if (k == first || at != tree.vertex_patches[k - 1].corners[0]) {
                    normals.push_back(tree.normals[rows[row]]);
                    weights.push_back(joined.at(row, at));
                }
                out.of_vertex_patches[k] = static_cast<std::uint32_t>(weights.size() - 1);
            }
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec3& normal = tree.normals[rows[row]];
            std::vector<std::uint32_t>& here = at_place[places[corner++]];
            std::size_t v = 0;
            while (v < here.size() && glm::dot(normals[here[v]], normal) <= one_surface) ++v;
            if (v == here.size()) {
                here.push_back(static_cast<std::uint32_t>(normals.size()));
                normals.push_back(normal);
                weights.emplace_back();
            }
            out.vertices[row][k] = here[v];
            weights[here[v]].emplace_back(row, tree.areas[rows[row]]);
        }
    }
    out.first.push_back(0);
    for (const LeafShares& here : weights) {
        double sum = 0.0;
        for (const auto& [row, weight] : here) sum += weight;
        for (const auto& [row, weight] : here)
            out.leaves.emplace_back(row, static_cast<float>(weight / sum));
        out.first.push_back(static_cast<std::uint32_t>(out.leaves.size()));
    }
    return out;
}

}  // namespace clgi
