// Closed solids of the generated rooms: blocks, turned pieces, cushions, prisms, carved boards.
//
// Every function adds one closed surface that faces outward. Light that is exchanged without
// visibility is blocked by closed surfaces alone, and corners of two solids at one place would
// join them, so neighbours stand apart or touch within faces.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/scene.hpp>
#include <functional>
#include <string>
#include <vector>

namespace clgi::generated {

// Where a piece stands: its own coordinates to the scene's. axes are orthonormal, right-handed.
struct Placement {
    glm::dvec3 origin = glm::dvec3(0.0);
    glm::dmat3 axes = glm::dmat3(1.0);

    glm::dvec3 operator()(const glm::dvec3& local) const { return origin + axes * local; }
    // A part of this piece, placed within it.
    Placement operator()(const Placement& part) const {
        return {(*this)(part.origin), axes * part.axes};
    }
};
// Turned about +Y, counter-clockwise seen from above, radians.
Placement placed(const glm::dvec3& origin, double turn = 0.0);
// Its y axis points along a direction.
Placement along(const glm::dvec3& origin, const glm::dvec3& direction);

// 12 triangles.
void add_block(Scene& scene, const Placement& at, const glm::dvec3& low, const glm::dvec3& high,
               std::uint32_t material);

// With edges cut off by `edge` metres: 44 triangles.
void add_blunt_block(Scene& scene, const Placement& at, const glm::dvec3& low,
                     const glm::dvec3& high, double edge, std::uint32_t material);

// A straight bar of square cross-section, 12 triangles.
void add_bar(Scene& scene, const Placement& at, const glm::dvec3& from, const glm::dvec3& to,
             double width, std::uint32_t material);

struct TurnedRing {
    double radius, height;
};
// A surface of revolution about y. The outline runs up along the outside; where it goes on inside
// and down, the piece is hollow. It is closed to the axis at both ends, or, as a loop, with itself.
// Bends of more than 40 degrees are sharp. 2 sides triangles between rings, sides at the axis.
enum class Outline { solid, loop };
void add_turned(Scene& scene, const Placement& at, const std::vector<TurnedRing>& outline,
                int sides, std::uint32_t material, Outline kind = Outline::solid);

// 4 sides triangles.
void add_rod(Scene& scene, const Placement& at, const glm::dvec3& from, const glm::dvec3& to,
             double radius, int sides, std::uint32_t material);

// A superellipsoid |x/a|^p + |y/b|^p + |z/c|^p = 1 about the origin, 2 sides (rings - 1) triangles:
// power 2 is an ellipsoid, 4 a cushion. sides: a multiple of 4.
void add_cushion(Scene& scene, const Placement& at, const glm::dvec3& half_size, double power,
                 int sides, int rings, std::uint32_t material);

// A convex outline in the xy plane, counter-clockwise, from z = low to high: 4 n - 4 triangles.
void add_prism(Scene& scene, const Placement& at, const std::vector<glm::dvec2>& outline,
               double low, double high, std::uint32_t material);

// A board in the xy plane, from z = 0 to thickness, whose openings are cut out: cells are given
// row by row from the top, '#' is wood. Cells that touch at a corner alone are refused: there the
// surface would meet itself.
void add_carved(Scene& scene, const Placement& at, const std::vector<std::string>& cells,
                const glm::dvec2& cell, double thickness, std::uint32_t material);

// The same with cuts of any width; both are asked for the cell right of cut i of x, above cut j of
// y. Neighbours may have different materials.
using Wood = std::function<bool(int i, int j)>;
using Grain = std::function<std::uint32_t(int i, int j)>;
void add_carved(Scene& scene, const Placement& at, const std::vector<double>& x,
                const std::vector<double>& y, const Wood& wood, double thickness,
                const Grain& material);

// Unit normals of vertices from `first` on: the mean of their triangles weighted by area.
// Triangles from first_triangle on are theirs.
void smooth_normals_of(Scene& scene, std::size_t first, std::size_t first_triangle);

}  // namespace clgi::generated
