// The elements of a scene: triangles cut to a size, and clusters above them, as one tree.
// [Dachsbacher07, section 3.1]
//
// The tree lies in depth-first order: the subtree of element i is [i, ends[i]), its first child is
// i + 1 and the next one begins where that child ends. Triangles of the scene are halved until they
// are small enough; they, their parts and the leaves are patches. Above them stand clusters of two
// to four children. The same scene gives the same tree in every run.
//
// Pieces of the mesh whose triangles are finer than that have leaves at their vertices instead,
// about half as many [section 4.3, Table 1]. Such a leaf has a vertex patch of each triangle around
// the vertex, and the mean of their normals. A vertex on a crease, or where materials meet, has a
// leaf for each side of it. Where these are more leaves than requested, those of neighbouring
// vertices are joined while together they are small, round and face about one way.
//
// Light passes an open sheet unless both of its sides are there to block it. So a triangle that is
// double-sided, or of a piece of the mesh that is not closed, has a second patch that faces
// backwards, wound against the first. Where there are backs, the root has two children: all fronts
// and all backs. Where some triangles move, the still ones have a cluster of their own in each.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clgi {

// Where the vertices of a scene are at times of a motion, in their order: [poses][vertices] metres.
// See vertex_poses() of clgi/advanced/moving_elements.hpp.
using VertexPoses = std::vector<std::vector<glm::dvec3>>;

struct ElementOptions {
    double max_area = 0.0;  // m^2 of a leaf; 0: what gives about the requested number of leaves
    double min_area = 0.0;  // m^2, the least that max_area becomes for the requested number
    // Leaves, about. In scenes of many small triangles, large ones are cut to four times the area
    // that a requested leaf has on average, and leaves at vertices are joined until there are about
    // as many as requested. Small triangles that have no leaves at vertices remain, however many.
    std::size_t requested = 8192;
    bool backs = true;  // of open sheets
    // Leaves at the vertices of fine meshes, where enough leaves remain and nothing moves.
    bool vertices = true;
};

// The part of a triangle at one of its corners: between the corner, the middles of the edges beside
// it and the centroid. It has a vertex patch of the area.
struct VertexPatch {
    std::array<glm::dvec3, 3> corners;  // of the triangle, as wound, that of the vertex first
    std::uint32_t triangle;             // of the scene
    std::uint32_t corner;               // of it, 0 to 2
};

struct ElementTree {
    std::vector<glm::dvec3> positions;  // metres: the centroid, of clusters weighted by area
    // Unit, of leaves, patches and still clusters whose triangles face one way in one plane, to a
    // thousandth of a radian and of the radius; zero for other clusters.
    std::vector<glm::dvec3> normals;
    std::vector<double> areas;  // m^2
    std::vector<double> radii;  // metres, of the sphere around the position that holds the subtree
    std::vector<std::array<glm::dvec3, 3>> corners;  // of patches, counter-clockwise; else zero
    std::vector<std::uint32_t> parents;              // no_index: the root
    std::vector<std::uint32_t> ends;
    std::vector<std::uint32_t> levels;  // 0: the root
    // Of the scene; no_index for clusters. Of a leaf at vertices one of those around them, all of
    // which have the same material.
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint8_t> backs;  // 1: a leaf or patch of the back of its triangle
    std::vector<std::uint32_t>
        first_patches;  // [elements + 1] in vertex patches; empty: none has any
    std::vector<VertexPatch> vertex_patches;  // of leaves at vertices
    std::vector<std::uint8_t> moving;         // 1: a vertex of the subtree moves; empty: none does

    double max_area = 0.0;  // m^2 that triangles were cut to
    std::size_t leaves = 0;
    std::size_t skipped_triangles = 0;  // without a normal that floats could tell
    double skipped_area = 0.0;          // m^2

    std::size_t count() const { return ends.size(); }
    bool is_leaf(std::size_t i) const { return ends[i] == i + 1; }
    bool is_patch(std::size_t i) const { return triangles[i] != no_index && !is_vertex(i); }
    bool is_vertex(std::size_t i) const {
        return !first_patches.empty() && first_patches[i] != first_patches[i + 1];
    }
    bool is_flat(std::size_t i) const { return normals[i] != glm::dvec3(0.0); }
    bool moves(std::size_t i) const { return !moving.empty() && moving[i] != 0; }
};

// The elements of the scene as its arrays hold it. With poses, triangles that move are apart from
// those that stand still, and so are those that part from each other in some pose.
// Throws InputError for vertices and materials that do not exist and for positions that are not
// finite, Error for an option out of range, for poses of another number of vertices and for more
// than 2^26 leaves.
CLGI_API ElementTree make_elements(const Scene& scene, const ElementOptions& options = {},
                                   const VertexPoses& poses = {});

}  // namespace clgi
