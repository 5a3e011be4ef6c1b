// Where the corners of leaves meet: vertices between which light is interpolated.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/elements.hpp>
#include <cstdint>
#include <utility>
#include <vector>

namespace clgi {

struct LeafVertices {
    std::vector<std::array<std::uint32_t, 3>> vertices;   // [rows] of corners; not of leaves at
                                                          // vertices, whose are of_vertex_patches
    std::vector<std::uint32_t> of_vertex_patches;         // [vertex patches of the tree]
    std::vector<std::uint32_t> first;                     // [vertices + 1] in leaves
    std::vector<std::pair<std::uint32_t, float>> leaves;  // row, share of the vertex: of area
};

// Corners in one place share a vertex where their leaves face nearly one way, within 26 degrees.
// A leaf at a vertex has one of its own, a joined leaf several (joined_shares.hpp). rows: leaves of
// the tree.
LeafVertices leaf_vertices(const ElementTree& tree, const std::vector<std::uint32_t>& rows);

}  // namespace clgi
