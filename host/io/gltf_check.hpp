// Checks of a model that tinygltf does not make.
// SPDX-License-Identifier: MIT
#pragma once

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// How the parts fit each other: throws InputError for weights, joints, morph targets and keys of
// animations that do not match in number or shape, and for what only a foreign extension gives.
void check_links(const Model& model);

// What the buffers hold, whether a node places it or not: throws InputError for attributes of the
// wrong format or of unequal length, for indices past the last vertex, and for numbers that are not
// finite except where they are mended: in the attributes other than POSITION. Expects
// check_accessors to have passed.
void check_meshes(const Document& document);

}  // namespace clgi::io::gltf
