// Convex pieces of triangles, cut by planes, with areas that are exact up to rounding.
//
// Corners of a piece are weights b1, b2 of its triangle's corners, where cuts are well conditioned
// however thin the triangle is.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// first + b1 edge1 + b2 edge2, metres.
struct PieceTriangle {
    glm::dvec3 first, edge1, edge2;
    double twice_area;  // m^2
};

struct Piece {
    static constexpr std::uint32_t most = 8;  // corners
    std::uint32_t triangle;                   // of the PieceTriangles
    std::uint32_t count;
    std::array<glm::dvec2, most> corners;  // b1, b2; counter-clockwise, as the triangle's
};

Piece whole_triangle(std::uint32_t triangle);

// Height along a direction as a function of the weights.
struct Slope {
    double at, along1, along2;
    Slope(const PieceTriangle& triangle, const glm::dvec3& direction)
        : at(glm::dot(triangle.first, direction)),
          along1(glm::dot(triangle.edge1, direction)),
          along2(glm::dot(triangle.edge2, direction)) {}
    double operator()(const glm::dvec2& b) const { return at + along1 * b.x + along2 * b.y; }
};

double area_of(const std::vector<PieceTriangle>& triangles, const Piece& piece);  // m^2

// Where the plane at a height meets a piece.
struct Crossing {
    glm::dvec2 from, to;  // weights
    double width = 0.0;   // area for each metre that the plane rises, m
};

struct Below {
    double area = 0.0;  // m^2 of the part under the plane
    Crossing crossing;
};
Below part_below(const std::vector<PieceTriangle>& triangles, const Piece& piece,
                 const Slope& slope, double height);

// The plane across `direction` with this area of the pieces below it; 0 < area < their sum.
double height_with_area(const std::vector<PieceTriangle>& triangles, const Piece* pieces,
                        std::size_t count, const glm::dvec3& direction, double area);

// Appends both parts of a piece; one with more corners than `most` becomes two.
void cut(const Piece& piece, const Slope& slope, double height, std::vector<Piece>& below,
         std::vector<Piece>& above);

}  // namespace clgi
