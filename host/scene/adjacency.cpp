// SPDX-License-Identifier: MIT
#include <clgi/advanced/adjacency.hpp>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <string>
#include <tuple>

#include "scene/disjoint_sets.hpp"
#include "scene/weld.hpp"

namespace clgi {
namespace {

void check(const std::vector<glm::dvec3>& positions, const std::vector<SceneTriangle>& triangles) {
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(positions[i][axis]))
                throw InputError("adjacency: position " + std::to_string(i) + " is not finite");
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (const std::uint32_t vertex : triangles[t].vertex)
            if (vertex >= positions.size())
                throw InputError("adjacency: triangle " + std::to_string(t) + " names vertex " +
                                 std::to_string(vertex) + ", there are " +
                                 std::to_string(positions.size()));
}

struct Side {
    std::uint32_t from, to;  // the smaller welded vertex first
    EdgeUse use;
};

// All sides, those of one edge together: put in by their first vertex, then each vertex's sorted.
std::vector<Side> sorted_sides(const std::vector<SceneTriangle>& triangles, Adjacency& out) {
    std::vector<Side> sides;
    sides.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        std::uint32_t corner[3];
        for (int k = 0; k < 3; ++k) corner[k] = out.welded[triangles[t].vertex[k]];
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) {
            ++out.degenerate;
            continue;
        }
        for (std::uint8_t k = 0; k < 3; ++k) {
            const std::uint32_t a = corner[k], b = corner[(k + 1) % 3];
            sides.push_back({std::min(a, b), std::max(a, b), {t, k, a < b}});
        }
    }
    std::vector<std::size_t> end(std::size_t{out.welded_count} + 1, 0);  // of each vertex's sides
    for (const Side& side : sides) ++end[side.from + 1];
    for (std::size_t v = 1; v < end.size(); ++v) end[v] += end[v - 1];
    std::vector<Side> sorted(sides.size());
    for (const Side& side : sides) sorted[end[side.from]++] = side;
    std::size_t first = 0;
    for (std::uint32_t v = 0; v < out.welded_count; first = end[v++])
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(first),
                  sorted.begin() + static_cast<std::ptrdiff_t>(end[v]),
                  [](const Side& a, const Side& b) {
                      return std::tie(a.to, a.use.triangle, a.use.side) <
                             std::tie(b.to, b.use.triangle, b.use.side);
                  });
    return sorted;
}

EdgeKind kind_of(const EdgeUse* uses, std::size_t count) {
    if (count == 1) return EdgeKind::border;
    if (count > 2) return EdgeKind::non_manifold;
    return uses[0].forward != uses[1].forward ? EdgeKind::manifold : EdgeKind::opposite;
}

}  // namespace

Adjacency adjacency(const std::vector<glm::dvec3>& positions,
                    const std::vector<SceneTriangle>& triangles) {
    check(positions, triangles);
    Adjacency out;
    out.welded = weld(positions, triangles);
    for (const std::uint32_t vertex : out.welded)
        out.welded_count = std::max(out.welded_count, vertex + 1);
    const std::array<std::uint32_t, 3> none{no_index, no_index, no_index};
    out.triangle_edges.assign(triangles.size(), none);
    out.neighbours.assign(triangles.size(), none);

    const std::vector<Side> sides = sorted_sides(triangles, out);
    out.uses.reserve(sides.size());
    for (const Side& side : sides) out.uses.push_back(side.use);
    DisjointSets sets(triangles.size());
    for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
        const Side& side = sides[first];
        while (last < sides.size() && sides[last].from == side.from && sides[last].to == side.to)
            ++last;
        const EdgeUse* uses = &out.uses[first];
        const std::size_t count = last - first;
        for (std::size_t i = 0; i < count; ++i) {
            out.triangle_edges[uses[i].triangle][uses[i].side] =
                static_cast<std::uint32_t>(out.edges.size());
            sets.join(uses[0].triangle, uses[i].triangle);
        }
        if (count == 2) {
            out.neighbours[uses[0].triangle][uses[0].side] = uses[1].triangle;
            out.neighbours[uses[1].triangle][uses[1].side] = uses[0].triangle;
        }
        out.edges.push_back({{side.from, side.to},
                             static_cast<std::uint32_t>(first),
                             static_cast<std::uint32_t>(count),
                             kind_of(uses, count)});
    }

    // Numbers without those of degenerate triangles, each of which is a set of its own.
    const std::vector<std::uint32_t> set = sets.numbered();
    std::vector<std::uint32_t> piece(triangles.size(), no_index);
    out.pieces.assign(triangles.size(), no_index);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (out.triangle_edges[t][0] == no_index) continue;
        if (piece[set[t]] == no_index) piece[set[t]] = out.piece_count++;
        out.pieces[t] = piece[set[t]];
    }
    return out;
}

Adjacency adjacency(const Scene& scene) { return adjacency(scene.positions, scene.triangles); }

std::size_t Adjacency::count(EdgeKind kind) const {
    return static_cast<std::size_t>(std::count_if(
        edges.begin(), edges.end(), [&](const MeshEdge& edge) { return edge.kind == kind; }));
}

bool Adjacency::closed() const { return count(EdgeKind::manifold) == edges.size(); }

}  // namespace clgi
