// Encoded images: what they are, how large they will be, and their pixels.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "io/gltf_container.hpp"

namespace clgi::io::gltf {

enum class ImageFormat { png, jpeg, unsupported, unknown };

// By the first bytes; 16 are enough. unsupported: a known format that glTF extensions allow.
ImageFormat image_format(Bytes bytes);

struct Pixels {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;
};

// Decodes a PNG or JPEG of at most `most` pixels. The size is taken from the header and judged
// before anything is decoded. Throws InputError.
Pixels decode_image(Bytes bytes, std::size_t most);

}  // namespace clgi::io::gltf
