// The node hierarchy: that it is a forest, where its nodes stand, and which belong to a scene.
// Nothing here recurses; a chain of a million nodes is a loop of a million steps.
// SPDX-License-Identifier: MIT
#pragma once

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Sets the nodes' parents and matrices. Throws InputError for a node
// with two parents, for a cycle, and for a transform that overflows.
void place_nodes(Document& document);

// The nodes of a scene, parents first. scene -1: the default scene, else the first, else, in a
// file without scenes, every node. Throws InputError when the file has no such scene.
std::vector<int> scene_nodes(Document& document, int scene);

}  // namespace clgi::io::gltf
