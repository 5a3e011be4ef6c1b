// The triangles of a primitive, whatever its mode, and the vertices that they use.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

struct Topology {
    std::vector<std::uint32_t> vertices;                  // of the primitive, those in use
    std::vector<std::array<std::uint32_t, 3>> triangles;  // positions in `vertices`
};

// How many triangles the mode makes of the primitive's indices; 0 for points and lines.
std::size_t triangle_count(const Document& document, const Primitive& primitive);

// Triangles that name a vertex twice, as strips have between rows, are left out.
Topology triangles_of(const Document& document, const Primitive& primitive);

}  // namespace clgi::io::gltf
