// Materials with their textures, from the document into the Scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/gltf.hpp>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Fills scene.materials, one for one, and scene.textures. Only images that a base color, an
// emission or a metallic-roughness texture needs are decoded; of the others only the start is
// looked at.
void load_materials(Document& document, const std::filesystem::path& folder,
                    const GltfOptions& options, Scene& scene);

}  // namespace clgi::io::gltf
