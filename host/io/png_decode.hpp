// The bytes of a PNG file to 8-bit RGBA, with libpng, row by row: a file whose compressed data
// expand without end costs no more memory than its header announces.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace clgi::io {

// rgba: [h][w][4]; w and h as in the file's header. Color profiles are ignored, 16 bits rounded
// to 8. Returns false when the file is damaged.
bool decode_png(std::span<const std::uint8_t> file, std::uint32_t w, std::uint32_t h,
                std::vector<std::uint8_t>& rgba);

}  // namespace clgi::io
