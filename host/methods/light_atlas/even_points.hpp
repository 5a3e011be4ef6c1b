// Points evenly spread over a surface, however it is cut into triangles.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "methods/light_atlas/pieces.hpp"

namespace clgi {

struct EvenPoint {
    std::uint32_t triangle;  // of the PieceTriangles
    glm::dvec2 b;            // weights of its second and third corner
};

// Halves the surface again and again, each time by a plane across its longest extent with areas in
// proportion to the points on either side, down to one cell of equal area for each point. The point
// lies in the middle of the cell, or off it by a low-discrepancy share of the cell, up to half of
// `jitter`: in the middle, neighbours are farthest apart; off it, points do not line up in rows.
// Neighbouring points are near each other in the list.
//
// Axes: x, y, z of the triangles' frame; the surface should lie along x and y where it is planar.
std::vector<EvenPoint> even_points(const std::vector<PieceTriangle>& triangles, std::uint32_t count,
                                   double jitter);

}  // namespace clgi
