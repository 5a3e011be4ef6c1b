// Where the corners of leaves meet: vertices between which light is interpolated.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/elements.hpp>
#include <cstdint>
#include <utility>
#include <vector>

namespace clgi {

struct LeafVertices {
    std::vector<std::array<std::uint32_t, 3>> vertices;   // [rows] of a leaf's corners; of a leaf
                                                          // at vertices thrice its first
    std::vector<std::uint32_t> of_thirds;                 // [thirds of the tree]
    std::vector<std::uint32_t> first;                     // [vertices + 1] in leaves
    std::vector<std::pair<std::uint32_t, float>> leaves;  // row, share of the vertex: of area
};

// Corners in one place share a vertex where their leaves face nearly one way, within 26 degrees.
// A leaf at a vertex has one of its own. Vertices of a joined leaf have the light of that leaf and
// of those beside it, the more the nearer they are. rows: leaves of the tree.
LeafVertices leaf_vertices(const ElementTree& tree, const std::vector<std::uint32_t>& rows);

}  // namespace clgi
