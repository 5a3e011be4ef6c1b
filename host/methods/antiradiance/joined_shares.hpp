// How the vertices of joined leaves share the light of the leaves around them, so that it is smooth
// across leaves. [derived; weights of Franke and Nielson 1980]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/elements.hpp>
#include <cstdint>
#include <utility>
#include <vector>

namespace clgi {

using LeafShares = std::vector<std::pair<std::uint32_t, double>>;  // row of a leaf, weight above 0

class JoinedShares {
public:
    // rows: leaves of the tree; both must outlive this object.
    JoinedShares(const ElementTree& tree, const std::vector<std::uint32_t>& rows);

    // For a vertex of the leaf of this row: of itself and of those beside it, ((R - d) / (R d))^2,
    // d: distance of the leaf, R: that of the farthest. A leaf at one vertex has its own light.
    LeafShares at(std::uint32_t row, const glm::dvec3& vertex) const;

private:
    bool joined(std::uint32_t row) const;

    const ElementTree& tree_;
    const std::vector<std::uint32_t>& rows_;
    std::vector<std::vector<std::uint32_t>>
        beside_;  // [rows] of joined leaves, they themselves too
};

}  // namespace clgi
