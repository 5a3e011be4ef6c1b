// The readers behind load_image: pictures as the file has them, non-finite samples included.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace clgi::io {

// Told apart by content. Throws InputError "file: what is wrong".
CLGI_API Image read_image(const std::filesystem::path& path);
Image read_exr(const std::filesystem::path& path);
Image read_hdr(const std::filesystem::path& path);

// Channels R, G, B, A: bytes / 255, still sRGB-encoded, 16 bits rounded to 8. No radiance, hence
// not among what read_image takes.
Image read_png(const std::filesystem::path& path);
CLGI_API Image read_image_or_png(const std::filesystem::path& path);

// What is put in place of a sample: NaN becomes 0, an infinity the largest float of its sign.
CLGI_API float finite(float sample);
CLGI_API std::size_t make_finite(Image& image);  // how many samples were replaced

// Throws InputError unless both sides are at least 1 and at most 65,536 and all samples together
// at most 2^30 (4 GiB), so that a few bytes of header cannot ask for more memory than there is.
void check_dimensions(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
                      std::int64_t channels);

}  // namespace clgi::io
