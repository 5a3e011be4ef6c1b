// Where a primitive's vertices are in the rest pose: morph targets at their default weights, then
// the skin or the node's matrix.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

struct Pose {
    std::vector<glm::dvec3> positions;   // world space
    std::vector<glm::dvec3> normals;     // world space, unit or zero; empty: the mesh has none
    std::vector<std::uint8_t> mirrored;  // 1 where the transform turns triangles inside out
};

// Expects place_nodes to have passed.
class Poser {
public:
    explicit Poser(Document& document) : document_(document) {}

    // vertices: ids within the primitive; matrix: what places an unskinned one.
    Pose pose(const Primitive& primitive, const Node& node, const glm::dmat4& matrix,
              const std::vector<std::uint32_t>& vertices);

private:
    void morph(const Primitive& primitive, const Node& node,
               const std::vector<std::uint32_t>& vertices, Pose& pose);
    const std::vector<glm::dmat4>& joint_matrices(int skin);

    Document& document_;
    std::map<int, std::vector<glm::dmat4>> joint_matrices_;  // of the skins met so far
    std::size_t differences_read_ = 0;
};

}  // namespace clgi::io::gltf
