// Brings the bytes of buffers and images into memory.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Fills Buffer::data. Each file beside the scene is read once, and no further than asked for.
void load_buffers(Document& document, const std::optional<Bytes>& binary_chunk,
                  const std::filesystem::path& folder);

// The encoded bytes of an image, of a file at most `limit`. `held` owns them when they are not
// part of a buffer.
Bytes picture_bytes(const Document& document, const Picture& picture,
                    const std::filesystem::path& folder, std::size_t limit,
                    std::vector<std::uint8_t>& held);

}  // namespace clgi::io::gltf
