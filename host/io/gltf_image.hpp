// Encoded images: what they are, how large they will be, and their pixels.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace clgi::io::gltf {

using Bytes = std::span<const std::uint8_t>;

enum class ImageFormat { png, jpeg, webp, unsupported };

// How much of an image inspect_image looks at: a page of a file. A JPEG whose size comes later is
// not judged.
constexpr std::size_t inspected_bytes = 4096;

// unsupported: a known format that glTF extensions allow, such as WebP in a build without
// CLGI_WEBP. Throws InputError for one that is not
// known, and for a PNG or JPEG that is broken before it says its size.
ImageFormat inspect_image(Bytes bytes);

// "PNG"
const char* name_of(ImageFormat format);

// Whether a media type like "image/gif" calls an image of another format.
bool contradicts(std::string_view media_type, ImageFormat format);

struct Pixels {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;
};

// Decodes a PNG, JPEG or WebP of at most `most` pixels. The size is taken from the header and
// judged before anything is decoded. Throws InputError.
Pixels decode_image(Bytes bytes, std::size_t most);

// The same for a WebP. Built with CLGI_WEBP alone.
Pixels decode_webp_file(Bytes bytes, std::size_t most);

}  // namespace clgi::io::gltf
