// Leaves at the vertices of fine meshes, or at a few neighbouring ones, in place of their
// triangles. [Dachsbacher07, section 4.3, Table 1: "Shared vertex mesh elements are created at
// vertices yielding fewer samples"]
//
//   area = sum of a_t / 3,  normal = sum of a_t n_t / 3, made unit,  t: triangles around the vertex
//
// Areas add up to those of the triangles. The position at one vertex is the centroid of the vertex
// patches, which all but is the vertex in the middle of a smooth surface, and lies beside it on a
// crease, where leaves of several sides would else coincide. Of several vertices that may lie far
// below a surface that is curved outwards: there it is the centroid of the nearest vertex patch.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/advanced/elements.hpp>
#include <cstdint>
#include <vector>

#include "methods/antiradiance/faces.hpp"

namespace clgi {

struct VertexCell {
    glm::dvec3 position{0.0};  // metres
    glm::dvec3 normal{0.0};    // unit
    double area = 0.0;         // m^2
    std::uint32_t first_patch = 0, end_patch = 0;
    bool back = false;
};

struct VertexCells {
    std::vector<VertexCell> cells;
    std::vector<VertexPatch> vertex_patches;  // by cell
    std::vector<Face> faces;                  // that no cell replaces, in their order
};

// Which cells there would be.
struct CellPlan {
    std::vector<std::uint32_t> cells;    // [3 * triangles] of corners
    std::vector<std::uint8_t> replaced;  // [pieces] have cells in place of faces
    bool joined = false;                 // cells are of several vertices
    double area = 0.0;                   // m^2, of all cells
    double count = 0.0;                  // of cells
    double leaves = 0.0;                 // these, and what faces are halved to
};

class VertexCellMaker {
public:
    // Both must outlive this object.
    VertexCellMaker(const Scene& scene, const Faces& faces);

    // Replaces all faces of the pieces in which no face and no cell is larger than max_area, m^2,
    // and that get fewer cells than they have faces, and none without a normal. Cells are joined
    // while they stay below joined_area.
    CellPlan plan(double max_area, double joined_area = 0.0) const;

    VertexCells operator()(const CellPlan& plan) const;

private:
    // Corners of one side whose faces are replaced: by cell, then by vertex, triangle and corner.
    std::vector<std::uint32_t> by_cell(const CellPlan& plan,
                                       const std::vector<std::uint32_t>& sides) const;
    void choose_pieces(double max_area, CellPlan& plan) const;
    void count(double max_area, CellPlan& plan) const;

    const Faces& all_;
    std::vector<std::uint32_t> fronts_, backs_;  // [triangles] in faces; no_index: none
    std::vector<std::uint32_t> vertices_;        // [3 * triangles] that corners meet at
};

// Corner, middle, centroid, middle: a plane quadrilateral, wound as the triangle is.
inline std::array<glm::dvec3, 4> outline(const VertexPatch& vertex_patch) {
    const std::array<glm::dvec3, 3>& p = vertex_patch.corners;
    return {p[0], 0.5 * (p[0] + p[1]), centroid(p), 0.5 * (p[0] + p[2])};
}

// Its centroid: that of its two halves, which are of one size.
inline glm::dvec3 centroid(const VertexPatch& vertex_patch) {
    const std::array<glm::dvec3, 3>& p = vertex_patch.corners;
    return (11.0 * p[0] + 3.5 * (p[1] + p[2])) / 18.0;
}

// m^2, of the square of the way from `middle` to the farthest corner of the outline.
inline double square_reach(const VertexPatch& vertex_patch, const glm::dvec3& middle) {
    double out = 0.0;
    for (const glm::dvec3& corner : outline(vertex_patch)) {
        const glm::dvec3 way = corner - middle;
        out = std::max(out, glm::dot(way, way));
    }
    return out;
}

inline glm::dvec3 vector_area(const VertexPatch& vertex_patch) {
    const std::array<glm::dvec3, 3>& p = vertex_patch.corners;
    return glm::cross(p[1] - p[0], p[2] - p[0]) / 6.0;
}

}  // namespace clgi
