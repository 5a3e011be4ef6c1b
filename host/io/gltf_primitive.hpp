// A primitive on its way into the Scene: which triangles it has, and where its vertices are.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

using Corners = std::array<std::uint32_t, 3>;

struct Topology {
    std::vector<std::uint32_t> vertices;  // of the primitive, those in use
    std::vector<Corners> triangles;       // positions in `vertices`
};

// How many triangles the mode makes of the primitive's indices; 0 for points and lines.
std::size_t triangle_count(const Document& document, const Primitive& primitive);

// Numbers the corners of triangles anew, from 0 on in the order of their ids, and returns the ids.
// The table is kept between calls: many small lists may point into an array of millions.
class Renumberer {
public:
    std::vector<std::uint32_t> renumber(std::vector<Corners>& triangles);

private:
    std::vector<std::uint32_t> number_;
};

// Triangles that name a vertex twice, as strips have between rows, are left out.
Topology triangles_of(const Document& document, const Primitive& primitive, Renumberer& renumberer);

struct PosedVertices {
    std::vector<glm::dvec3> positions;   // world space
    std::vector<glm::dvec3> normals;     // world space, unit or zero; empty: the mesh has none
    std::vector<std::uint8_t> mirrored;  // 1 where the transform turns triangles inside out
};

// The rest pose: morph targets at their default weights, then the skin or the node's matrix.
class Poser {
public:
    explicit Poser(Document& document) : document_(document) {}

    // matrix: what places an unskinned primitive.
    PosedVertices pose(const Primitive& primitive, const Node& node, const glm::dmat4& matrix,
                       const std::vector<std::uint32_t>& vertices);

private:
    void morph(const Primitive& primitive, const Node& node,
               const std::vector<std::uint32_t>& vertices, PosedVertices& pose);
    const std::vector<glm::dmat4>& joint_matrices(int skin);

    Document& document_;
    std::map<int, std::vector<glm::dmat4>> joint_matrices_;  // of the skins met so far
    std::size_t differences_read_ = 0;
    std::size_t influences_read_ = 0;
};

// For a mesh without normals: gives every triangle three vertices of its own, which carry the
// normal of its front, as the specification asks.
void make_flat(Topology& topology, PosedVertices& pose);

// Replaces normals of no direction by the mean of the triangles around the vertex. Returns
// whether there were any.
bool repair_normals(const Topology& topology, PosedVertices& pose);

}  // namespace clgi::io::gltf
