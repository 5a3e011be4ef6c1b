// From the bytes of a file to tinygltf's model.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Fills model, image_types, quantized and warnings. Of the model is known: members are of their
// kind, indices in their range, views inside their buffers, whose data are there. What the buffers
// hold is not judged yet. Throws InputError.
Document parse(const std::filesystem::path& path);

}  // namespace clgi::io::gltf
