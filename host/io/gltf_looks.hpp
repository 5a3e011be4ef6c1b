// Texture coordinates and colors of vertices.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Appends to scene.uvs (where the scene is textured) and scene.colors (where any of its meshes
// has colors) an entry for each vertex of the primitive. Numbers that are not finite are mended.
// Returns whether there were any.
bool append_looks(const Document& document, const Primitive& primitive,
                  const std::vector<std::uint32_t>& vertices, bool textured, bool colored,
                  Scene& scene);

}  // namespace clgi::io::gltf
