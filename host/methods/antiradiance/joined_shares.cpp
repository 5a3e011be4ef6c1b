// SPDX-License-Identifier: MIT
#include "methods/antiradiance/joined_shares.hpp"

#include <algorithm>
#include <array>

namespace clgi {
namespace {

constexpr double alike = 0.5;  // cosine between the normals of leaves that share light

}  // namespace

bool JoinedShares::joined(std::uint32_t row) const {
    const std::uint32_t i = rows_[row];
    if (!tree_.is_vertex(i)) return false;
    const auto first = tree_.vertex_patches.begin() + tree_.first_patches[i];
    return std::any_of(first, tree_.vertex_patches.begin() + tree_.first_patches[i + 1],
                       [&](const VertexPatch& one) { return one.corners[0] != first->corners[0]; });
}

// Leaves are beside each other where a triangle has corners in both.
JoinedShares::JoinedShares(const ElementTree& tree, const std::vector<std::uint32_t>& rows)
    : tree_(tree), rows_(rows), beside_(rows.size()) {
    std::size_t triangles = 0;
    for (const VertexPatch& vertex_patch : tree.vertex_patches)
        triangles = std::max(triangles, vertex_patch.triangle + std::size_t{1});
    using Corners = std::array<std::uint32_t, 3>;  // rows
    std::vector<Corners> met(2 * triangles, Corners{no_index, no_index, no_index});
    const auto each = [&](const auto& visit) {
        for (std::uint32_t row = 0; row < rows.size(); ++row) {
            const std::uint32_t i = rows[row];
            if (!tree.is_vertex(i)) continue;
            for (std::uint32_t k = tree.first_patches[i]; k < tree.first_patches[i + 1]; ++k)
                visit(row, met[2 * std::size_t{tree.vertex_patches[k].triangle} + tree.backs[i]],
                      tree.vertex_patches[k].corner);
        }
    };
    each([](std::uint32_t row, Corners& corners, std::uint32_t k) { corners[k] = row; });
    each([&](std::uint32_t row, const Corners& corners, std::uint32_t) {
        for (const std::uint32_t other : corners)
            if (other != no_index &&
                glm::dot(tree.normals[rows[row]], tree.normals[rows[other]]) > alike)
                beside_[row].push_back(other);
    });
    for (std::uint32_t row = 0; row < rows.size(); ++row) {
        std::vector<std::uint32_t>& found = beside_[row];
        if (!joined(row)) found.clear();
        std::sort(found.begin(), found.end());
        found.erase(std::unique(found.begin(), found.end()), found.end());
    }
}

LeafShares JoinedShares::at(std::uint32_t row, const glm::dvec3& vertex) const {
    const auto distance = [&](std::uint32_t other) {
        return glm::length(tree_.positions[rows_[other]] - vertex);
    };
    double farthest = 0.0;
    for (const std::uint32_t other : beside_[row]) farthest = std::max(farthest, distance(other));
    const double own = distance(row);
    if (!(own > 0.0 && own < farthest)) return {{row, 1.0}};
    LeafShares out;
    for (const std::uint32_t other : beside_[row]) {
        const double d = distance(other);
        if (!(d > 0.0)) return {{other, 1.0}};
        const double weight = (farthest - d) / (farthest * d);
        if (weight > 0.0) out.emplace_back(other, weight * weight);
    }
    return out;
}

}  // namespace clgi
