// Checks of what the buffers hold, for every mesh of the file whether it is placed or not.
// SPDX-License-Identifier: MIT
#pragma once

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Throws InputError for attributes of the wrong format or of unequal length, for indices past the
// last vertex, and for positions that are not finite. Expects check_accessors to have passed.
void check_meshes(const Document& document);

}  // namespace clgi::io::gltf
