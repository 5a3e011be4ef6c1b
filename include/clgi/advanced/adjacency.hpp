// Which triangles meet where: vertices welded over seams of attributes, edges, neighbours, pieces.
//
// Two vertices are one when every coordinate of theirs is within two float spacings of the other's:
// each was rounded once. The spacing is that of a float as large as the largest coordinate, counted
// from the middle of the scene, of the vertex and of the triangles that it belongs to; the device
// could not tell such vertices apart either. Chains of near vertices become one vertex. A triangle
// of which two corners become one is degenerate: it has no edges and belongs to no piece, and its
// neighbours meet in its place.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

constexpr std::uint32_t no_index = 0xffffffffu;

// A triangle's side along an edge. Side k runs from corner k to corner (k + 1) % 3.
struct EdgeUse {
    std::uint32_t triangle;
    std::uint8_t side;
    bool forward;  // from the edge's first vertex to its second
};

enum class EdgeKind : std::uint8_t {
    border,        // one triangle
    manifold,      // two, wound alike: they run along it in opposite directions
    opposite,      // two, wound against each other
    non_manifold,  // three and more
};

struct MeshEdge {
    std::uint32_t vertex[2];  // welded, the smaller first
    std::uint32_t first_use;  // in Adjacency::uses, by triangle and side
    std::uint32_t use_count;
    EdgeKind kind;
};

struct Adjacency {
    std::vector<std::uint32_t> welded;  // [vertices] welded vertex, numbered as they first appear
    std::uint32_t welded_count = 0;
    std::vector<MeshEdge> edges;  // by their vertices
    std::vector<EdgeUse> uses;
    // [triangles][side] edge; no_index for degenerate triangles.
    std::vector<std::array<std::uint32_t, 3>> triangle_edges;
    // [triangles][side] the other triangle of an edge of two, wound alike or not; else no_index.
    std::vector<std::array<std::uint32_t, 3>> neighbours;
    // [triangles] piece: what edges of any kind connect, numbered as they first appear. A vertex in
    // common does not connect. no_index for degenerate triangles.
    std::vector<std::uint32_t> pieces;
    std::uint32_t piece_count = 0;
    std::uint32_t degenerate = 0;  // triangles

    CLGI_API std::size_t count(EdgeKind kind) const;  // edges of a kind
    CLGI_API bool closed() const;                     // every edge has two triangles, wound alike
};

// In nearly linear time; the same result on every machine. Throws InputError for vertices that do
// not exist and positions that are not finite.
CLGI_API Adjacency adjacency(const std::vector<glm::dvec3>& positions,
                             const std::vector<SceneTriangle>& triangles);
CLGI_API Adjacency adjacency(const Scene& scene);

}  // namespace clgi
