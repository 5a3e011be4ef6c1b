// Checks of what the buffers hold, whether a node places it or not.
// SPDX-License-Identifier: MIT
#pragma once

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Throws InputError for attributes of the wrong format or of unequal length, for indices past the
// last vertex, and for numbers that are not finite except where they are mended: in the attributes
// other than POSITION. Expects check_accessors to have passed.
void check_meshes(const Document& document);

}  // namespace clgi::io::gltf
