// Puts what the nodes of a scene carry into the Scene: triangles, lights, cameras.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/gltf.hpp>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Fills Document::lights and cameras, one for one. Throws InputError for numbers that mean no light
// or camera, whether a node carries it or not.
void read_lights(Document& document);

// Expects place_nodes and all checks to have passed, and scene.materials to be filled.
void place_meshes(Document& document, const std::vector<int>& nodes, const GltfOptions& options,
                  Scene& scene);
void place_lights(Document& document, const std::vector<int>& nodes, Scene& scene);
void place_cameras(Document& document, const std::vector<int>& nodes, Scene& scene);

}  // namespace clgi::io::gltf
