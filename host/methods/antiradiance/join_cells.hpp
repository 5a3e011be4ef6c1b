// Cells of neighbouring vertices as one, where a mesh is finer than leaves need to be. [derived]
//
// Cells that an edge connects are joined while what they make together is small, faces about one
// way and is round. The allowed area doubles from round to round, so that small cells are joined
// first and none grows at the cost of all others.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/antiradiance/faces.hpp"

namespace clgi {

// cells: [3 * triangles] numbers of the cells of the corners of triangles. fronts: [triangles] in
// faces. Returns cells joined, none of them larger than max_area, m^2, but for what was.
std::vector<std::uint32_t> join_cells(const std::vector<std::uint32_t>& cells,
                                      const std::vector<Face>& faces,
                                      const std::vector<std::uint32_t>& fronts, double max_area);

}  // namespace clgi
