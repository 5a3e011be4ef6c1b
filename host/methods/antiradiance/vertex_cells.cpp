// SPDX-License-Identifier: MIT
#include "methods/antiradiance/vertex_cells.hpp"

#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <cmath>
#include <limits>

#include "methods/antiradiance/join_cells.hpp"
#include "methods/antiradiance/leaf_area.hpp"
#include "scene/disjoint_sets.hpp"

namespace clgi {
namespace {

constexpr double smooth = 0.9;     // cosine between normals of triangles that an edge joins
constexpr double rounding = 1e-9;  // of sums of areas
constexpr double least = 0.8;  // least vector area of a cell, of its area: needles have no normal

// [faces] of each triangle's front, or of each back; no_index: none.
std::vector<std::uint32_t> by_triangle(const std::vector<Face>& faces, std::size_t triangles,
                                       bool back) {
    std::vector<std::uint32_t> out(triangles, no_index);
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        if (faces[f].back == back) out[faces[f].triangle] = f;
    return out;
}

// [3 * triangles] which corners of triangles meet at one vertex, within one smooth surface of one
// material. Fans that touch at a vertex alone stay apart.
std::vector<std::uint32_t> smooth_corners(const Scene& scene, const Adjacency& mesh,
                                          const std::vector<Face>& faces,
                                          const std::vector<std::uint32_t>& fronts) {
    DisjointSets sets(3 * fronts.size());
    const auto vertex = [&](std::uint32_t t, std::uint32_t corner) {
        return mesh.welded[scene.triangles[t].vertex[corner]];
    };
    for (std::uint32_t t = 0; t < fronts.size(); ++t)
        for (std::uint32_t side = 0; side < 3; ++side) {
            const std::uint32_t other = mesh.neighbours[t][side];
            if (other == no_index || other < t || fronts[t] == no_index ||
                fronts[other] == no_index ||
                scene.triangles[t].material != scene.triangles[other].material ||
                glm::dot(faces[fronts[t]].normal, faces[fronts[other]].normal) <= smooth)
                continue;
            for (const std::uint32_t corner : {side, (side + 1) % 3})
                for (std::uint32_t k = 0; k < 3; ++k)
                    if (vertex(other, k) == vertex(t, corner))
                        sets.join(3 * t + corner, 3 * other + k);
        }
    return sets.numbered();
}

// The cell's position, or where that lies below a curved surface, the centroid of the nearest
// vertex patch.
glm::dvec3 not_below(const VertexCells& all, const VertexCell& cell) {
    glm::dvec3 out(0.0);
    double nearest = std::numeric_limits<double>::max();
    for (std::uint32_t k = cell.first_patch; k < cell.end_patch; ++k) {
        const glm::dvec3 middle = centroid(all.vertex_patches[k]), way = middle - cell.position;
        if (!(glm::dot(way, way) < nearest)) continue;
        nearest = glm::dot(way, way);
        out = middle;
    }
    return glm::dot(cell.normal, out - cell.position) > 0.0 ? out : cell.position;
}

void measure(const VertexCells& all, const std::vector<Face>& faces,
             const std::vector<std::uint32_t>& of, bool joined, VertexCell& cell) {
    glm::dvec3 moment(0.0);
    const glm::dvec3& first = faces[of[all.vertex_patches[cell.first_patch].triangle]].normal;
    bool flat = true;
    for (std::uint32_t k = cell.first_patch; k < cell.end_patch; ++k) {
        const Face& face = faces[of[all.vertex_patches[k].triangle]];
        const double vertex_patch = face.area / 3.0;
        cell.area += vertex_patch;
        cell.normal += vertex_patch * face.normal;
        flat = flat && face.normal == first;
        moment += vertex_patch * centroid(all.vertex_patches[k]);
    }
    cell.position = moment / cell.area;
    cell.normal = flat ? first : glm::normalize(cell.normal);
    if (joined) cell.position = not_below(all, cell);
}

}  // namespace

VertexCellMaker::VertexCellMaker(const Scene& scene, const Faces& faces)
    : all_(faces),
      fronts_(by_triangle(faces.faces, scene.triangles.size(), false)),
      backs_(by_triangle(faces.faces, scene.triangles.size(), true)),
      vertices_(smooth_corners(scene, faces.mesh, faces.faces, fronts_)) {}

// What a piece would have: its largest leaf, how many, and whether one has no normal.
void VertexCellMaker::choose_pieces(double max_area, CellPlan& plan) const {
    const Adjacency& mesh = all_.mesh;
    const std::vector<std::uint32_t>& cells = plan.cells;
    std::vector<double> largest(mesh.piece_count, 0.0);
    std::vector<std::uint8_t> pointed(mesh.piece_count, 0);
    std::vector<std::uint32_t> face_count(mesh.piece_count, 0), cell_count(mesh.piece_count, 0);
    std::vector<double> areas(cells.size(), 0.0);
    std::vector<glm::dvec3> normals(cells.size(), glm::dvec3(0.0));
    for (const Face& face : all_.faces) {
        const std::uint32_t piece = mesh.pieces[face.triangle];
        largest[piece] = std::max(largest[piece], face.area);
        if (face.back) continue;
        ++face_count[piece];
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t cell = cells[3 * face.triangle + k];
            if (areas[cell] == 0.0) ++cell_count[piece];
            areas[cell] += face.area / 3.0;
            normals[cell] += face.area / 3.0 * face.normal;
            largest[piece] = std::max(largest[piece], areas[cell]);
        }
    }
    for (const Face& face : all_.faces)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t cell = cells[3 * face.triangle + k];
            if (glm::length(normals[cell]) < least * areas[cell])
                pointed[mesh.pieces[face.triangle]] = 1;
        }
    plan.replaced.resize(mesh.piece_count);
    for (std::size_t piece = 0; piece < mesh.piece_count; ++piece)
        plan.replaced[piece] = largest[piece] <= max_area * (1.0 + rounding) &&
                               cell_count[piece] < face_count[piece] && !pointed[piece];
}

void VertexCellMaker::count(double max_area, CellPlan& plan) const {
    std::vector<std::uint8_t> seen(2 * plan.cells.size(), 0);  // fronts, then backs
    for (const Face& face : all_.faces) {
        if (plan.replaced[all_.mesh.pieces[face.triangle]] == 0) {
            plan.leaves += std::ldexp(1.0, halvings(face.area, max_area));
            continue;
        }
        plan.area += face.area;
        for (std::uint32_t k = 0; k < 3; ++k) {
            std::uint8_t& here =
                seen[plan.cells[3 * face.triangle + k] + (face.back ? plan.cells.size() : 0)];
            if (here == 0) plan.count += 1.0;
            here = 1;
        }
    }
    plan.leaves += plan.count;
}

CellPlan VertexCellMaker::plan(double max_area, double joined_area) const {
    CellPlan out;
    out.cells = join_cells(vertices_, all_.faces, fronts_, joined_area);
    out.joined = joined_area > 0.0;
    choose_pieces(max_area, out);
    count(max_area, out);
    return out;
}

std::vector<std::uint32_t> VertexCellMaker::by_cell(const CellPlan& plan,
                                                    const std::vector<std::uint32_t>& sides) const {
    std::vector<std::uint32_t> order;
    for (std::uint32_t c = 0; c < plan.cells.size(); ++c)
        if (sides[c / 3] != no_index && plan.replaced[all_.mesh.pieces[c / 3]] != 0)
            order.push_back(c);
    // Numbers of vertices and cells are below that of corners: counted, the last digit first.
    for (const std::vector<std::uint32_t>* keys : {&vertices_, &plan.cells}) {
        std::vector<std::uint32_t> place(keys->size() + 1, 0), sorted(order.size());
        for (const std::uint32_t c : order) ++place[(*keys)[c] + 1];
        for (std::size_t k = 1; k < place.size(); ++k) place[k] += place[k - 1];
        for (const std::uint32_t c : order) sorted[place[(*keys)[c]]++] = c;
        order.swap(sorted);
    }
    return order;
}

VertexCells VertexCellMaker::operator()(const CellPlan& plan) const {
    const std::vector<Face>& faces = all_.faces;
    VertexCells out;
    for (const Face& face : faces)
        if (plan.replaced[all_.mesh.pieces[face.triangle]] == 0) out.faces.push_back(face);
    for (const bool back : {false, true}) {
        const std::vector<std::uint32_t>& sides = back ? backs_ : fronts_;
        const std::vector<std::uint32_t> order = by_cell(plan, sides);
        out.vertex_patches.reserve(out.vertex_patches.size() + order.size());
        for (std::size_t i = 0; i < order.size(); ++i) {
            const std::uint32_t t = order[i] / 3, corner = order[i] % 3;
            if (i == 0 || plan.cells[order[i]] != plan.cells[order[i - 1]]) {
                out.cells.emplace_back();
                out.cells.back().first_patch =
                    static_cast<std::uint32_t>(out.vertex_patches.size());
                out.cells.back().back = back;
            }
            // Corners of backs run the other way round, from the same first one.
            const std::array<glm::dvec3, 3>& p = faces[fronts_[t]].corners;
            const std::uint32_t next = (corner + (back ? 2 : 1)) % 3;
            const std::uint32_t last = (corner + (back ? 1 : 2)) % 3;
            out.vertex_patches.push_back({{p[corner], p[next], p[last]}, t, corner});
            out.cells.back().end_patch = static_cast<std::uint32_t>(out.vertex_patches.size());
        }
        for (VertexCell& cell : out.cells)
            if (cell.back == back) measure(out, faces, sides, plan.joined, cell);
    }
    return out;
}

}  // namespace clgi
