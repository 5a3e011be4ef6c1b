// Reading and writing pictures: OpenEXR, PNG, Radiance HDR. No partial file is ever left.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/export.hpp>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace clgi::io {

// Float planes of one size, row 0 at the top.
struct CLGI_API Image {
    struct Channel {
        std::string name;           // "R", "G", "B", "A", "normal.X" ...
        std::vector<float> values;  // [height][width]
    };
    int width = 0;
    int height = 0;
    std::vector<Channel> channels;
    std::map<std::string, std::string> attributes;  // e.g. {"clgi:quantity", "radiance"}

    const Channel* find(const std::string& name) const;  // null when there is none
};

// Radiance in cd/m^2 as a picture, with its quantity and unit. planes: R, G and B, [height][width]
// each, as Renderer::read_radiance() has them. Throws Error for planes of another size.
CLGI_API Image radiance_image(int width, int height, std::array<std::vector<float>, 3> planes);

enum class PixelType { half, full };

struct LoadReport {
    std::size_t non_finite = 0;  // samples that were NaN or infinite, now 0 or the largest float
};

// Reads .exr (scanline or tiled, first part) or .hdr (recognised by content). Non-finite samples
// are replaced and counted in report. Throws InputError: "file: what is wrong".
CLGI_API Image load_image(const std::filesystem::path& path, LoadReport* report = nullptr);

// Writes EXR, ZIP-compressed. half saturates at 65504 instead of becoming infinite.
// Attributes become string attributes of the header.
CLGI_API void save_exr(const Image& image, const std::filesystem::path& path, PixelType type);

// Writes an 8-bit sRGB PNG from RGBA bytes, row 0 at the top. rgba: [height][width][4]
CLGI_API void save_png(int width, int height, const std::vector<std::uint8_t>& rgba,
                       const std::filesystem::path& path);

}  // namespace clgi::io
