// SPDX-License-Identifier: MIT
#include "antiradiance/leaf_vertices.hpp"

#include "scene/weld.hpp"

namespace clgi {
namespace {

constexpr double alike = 0.9;  // cosine between the normals of leaves that share a vertex

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
    std::vector<double> areas;
    LeafVertices out;
    out.vertices.resize(rows.size());
    std::vector<std::vector<std::uint32_t>> around;  // rows of each vertex
    std::size_t corner = 0;
    for (std::uint32_t row = 0; row < rows.size(); ++row) {
        if (tree.is_vertex(rows[row])) {
            out.vertices[row].fill(static_cast<std::uint32_t>(around.size()));
            normals.push_back(tree.normals[rows[row]]);
            areas.push_back(tree.areas[rows[row]]);
            around.emplace_back(1, row);
            continue;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec3& normal = tree.normals[rows[row]];
            std::vector<std::uint32_t>& here = at_place[places[corner++]];
            std::size_t v = 0;
            while (v < here.size() && glm::dot(normals[here[v]], normal) <= alike) ++v;
            if (v == here.size()) {
                here.push_back(static_cast<std::uint32_t>(normals.size()));
                normals.push_back(normal);
                areas.push_back(0.0);
                around.emplace_back();
            }
            out.vertices[row][k] = here[v];
            areas[here[v]] += tree.areas[rows[row]];
            around[here[v]].push_back(row);
        }
    }
    out.first.push_back(0);
    for (std::size_t v = 0; v < around.size(); ++v) {
        for (const std::uint32_t row : around[v])
            out.leaves.emplace_back(row, static_cast<float>(tree.areas[rows[row]] / areas[v]));
        out.first.push_back(static_cast<std::uint32_t>(out.leaves.size()));
    }
    return out;
}

}  // namespace clgi
