// 8-bit RGBA to the bytes of a PNG file.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <cstdint>
#include <vector>

namespace clgi::io {

// rgba: [h][w][4], row 0 at the top. Throws Error for a size that is not positive, or that a PNG
// cannot have.
CLGI_API std::vector<std::uint8_t> encode_png(int w, int h, const std::uint8_t* rgba);

}  // namespace clgi::io
