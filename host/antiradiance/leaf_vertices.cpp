// SPDX-License-Identifier: MIT
#include "antiradiance/leaf_vertices.hpp"

#include <algorithm>

#include "scene/weld.hpp"

namespace clgi {
namespace {

constexpr double alike = 0.9;   // cosine between the normals of leaves that share a vertex
constexpr double beside = 0.5;  // and of joined leaves beside each other

using Shares = std::vector<std::pair<std::uint32_t, float>>;

// [rows] of leaves at vertices: those beside them that face nearly one way, and they themselves.
std::vector<std::vector<std::uint32_t>> rows_beside(const ElementTree& tree,
                                                    const std::vector<std::uint32_t>& rows) {
    std::size_t triangles = 0;
    for (const VertexThird& third : tree.thirds)
        triangles = std::max(triangles, third.triangle + std::size_t{1});
    constexpr std::array<std::uint32_t, 3> none = {no_index, no_index, no_index};
    std::vector<std::array<std::uint32_t, 3>> met(2 * triangles, none);  // fronts, backs
    const auto each = [&](const auto& visit) {
        for (std::uint32_t row = 0; row < rows.size(); ++row) {
            const std::uint32_t i = rows[row];
            if (!tree.is_vertex(i)) continue;
            for (std::uint32_t k = tree.first_thirds[i]; k < tree.first_thirds[i + 1]; ++k)
                visit(row, met[2 * std::size_t{tree.thirds[k].triangle} + tree.backs[i]],
                      tree.thirds[k].corner);
        }
    };
    each([](std::uint32_t row, auto& at, std::uint32_t corner) { at[corner] = row; });
    std::vector<std::vector<std::uint32_t>> out(rows.size());
    each([&](std::uint32_t row, const auto& at, std::uint32_t) {
        for (const std::uint32_t other : at)
            if (other != no_index &&
                glm::dot(tree.normals[rows[row]], tree.normals[rows[other]]) > beside)
                out[row].push_back(other);
    });
    for (std::vector<std::uint32_t>& found : out) {
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
    }
    return out;
}

// Weights of Franke and Little: ((R - d) / (R d))^2 within R, the farthest of these leaves.
Shares shares_at(const ElementTree& tree, const std::vector<std::uint32_t>& rows,
                 const std::vector<std::uint32_t>& near, std::uint32_t row, const glm::dvec3& at) {
    const double own = glm::length(tree.positions[rows[row]] - at);
    double farthest = 0.0;
    for (const std::uint32_t other : near)
        farthest = std::max(farthest, glm::length(tree.positions[rows[other]] - at));
    if (!(own > 0.0) || !(farthest > own)) return {{row, 1.0f}};
    std::vector<double> weights;
    double sum = 0.0;
    for (const std::uint32_t other : near) {
        const double d = glm::length(tree.positions[rows[other]] - at);
        const double ratio = d > 0.0 ? (farthest - d) / d : 1e6;
        weights.push_back(ratio * ratio);
        sum += weights.back();
    }
    Shares out;
    for (std::size_t k = 0; k < near.size(); ++k)
        if (weights[k] > 0.0) out.emplace_back(near[k], static_cast<float>(weights[k] / sum));
    return out;
}

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
    out.of_thirds.assign(tree.thirds.size(), 0);
    const std::vector<std::vector<std::uint32_t>> near = rows_beside(tree, rows);
    std::vector<Shares> shares;                      // of each vertex of a joined leaf
    std::vector<std::vector<std::uint32_t>> around;  // rows of each other vertex
    std::size_t corner = 0;
    for (std::uint32_t row = 0; row < rows.size(); ++row) {
        if (tree.is_vertex(rows[row])) {
            const std::uint32_t i = rows[row], first = tree.first_thirds[i];
            out.vertices[row].fill(static_cast<std::uint32_t>(around.size()));
            const bool joined = std::any_of(
                tree.thirds.begin() + first, tree.thirds.begin() + tree.first_thirds[i + 1],
                [&](const VertexThird& third) {
                    return third.corners[0] != tree.thirds[first].corners[0];
                });
            for (std::uint32_t k = first; k < tree.first_thirds[i + 1]; ++k) {
                const glm::dvec3& at = tree.thirds[k].corners[0];
                if (k == first || at != tree.thirds[k - 1].corners[0]) {
                    normals.push_back(tree.normals[i]);
                    areas.push_back(tree.areas[i]);
                    around.emplace_back(1, row);
                    shares.resize(around.size());
                    if (joined) shares.back() = shares_at(tree, rows, near[row], row, at);
                }
                out.of_thirds[k] = static_cast<std::uint32_t>(around.size() - 1);
            }
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
    shares.resize(around.size());
    for (std::size_t v = 0; v < around.size(); ++v) {
        out.leaves.insert(out.leaves.end(), shares[v].begin(), shares[v].end());
        if (shares[v].empty())
            for (const std::uint32_t row : around[v])
                out.leaves.emplace_back(row, static_cast<float>(tree.areas[rows[row]] / areas[v]));
        out.first.push_back(static_cast<std::uint32_t>(out.leaves.size()));
    }
    return out;
}

}  // namespace clgi
