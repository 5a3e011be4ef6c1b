// EXT_mesh_gpu_instancing: the matrices of a node's copies of its mesh.
// SPDX-License-Identifier: MIT
#pragma once

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// 1 for a node without the extension.
std::size_t instance_count(const Document& document, const Node& node);

// World matrices, instance < instance_count.
glm::dmat4 instance_matrix(const Document& document, int node, std::size_t instance);

bool is_instanced(const Node& node);

// Throws InputError for attributes of the wrong format or of unequal length.
void check_instancing(const Document& document);

}  // namespace clgi::io::gltf
