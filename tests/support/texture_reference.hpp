// A texture lookup in double precision, from what docs/materials.md and clgi/shared/scene.h say:
// trilinear between mip levels, bilinear or nearest in each, sRGB decoded before interpolation.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

#include "device.hpp"

namespace clgi::test {

struct Textures {
    std::vector<TextureRecord> records;
    std::vector<std::uint32_t> texels;
};

// The pool as the device has it: levels are made on the host.
inline Textures read_textures(const DeviceScene& scene) {
    const auto read = [&](const cl::Buffer& buffer, auto& out) {
        out.resize(buffer.getInfo<CL_MEM_SIZE>() / sizeof out[0]);
        device().queue.enqueueReadBuffer(buffer, CL_TRUE, 0, out.size() * sizeof out[0],
                                         out.data());
    };
    Textures out;
    read(*scene.kernel_arguments()[6], out.records);
    read(*scene.kernel_arguments()[7], out.texels);
    return out;
}

inline double decoded_srgb(double s) {
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

struct TextureTexel {
    glm::dvec4 color;
    bool near_border = false;  // rounding may choose the next texel
};

// The texel of an index on an endless row.
inline int wrapped_texel(double index, int size, std::uint32_t wrap) {
    if (wrap == 2) return static_cast<int>(std::min(std::max(index, 0.0), size - 1.0));
    const double period = wrap == 1 ? 2.0 * size : size;
    const double folded = index - period * std::floor(index / period);
    return static_cast<int>(folded < size ? folded : period - 1 - folded);
}

// One level; slack: texels within which a nearest texel counts as near a border.
inline TextureTexel level_texel(const Textures& textures, const TextureRecord& record, int level,
                                glm::dvec2 uv, double slack) {
    std::size_t first = record.first_texel;
    int size[2] = {record.width, record.height};
    for (int k = 0; k < level; ++k) {
        first += static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]);
        for (int& side : size) side = std::max(side / 2, 1);
    }
    const std::uint32_t wrap[2] = {record.flags & 3u, record.flags >> 2 & 3u};
    const auto texel = [&](double x, double y) {
        const std::uint32_t word =
            textures.texels[first +
                            static_cast<std::size_t>(wrapped_texel(y, size[1], wrap[1])) *
                                static_cast<std::size_t>(size[0]) +
                            static_cast<std::size_t>(wrapped_texel(x, size[0], wrap[0]))];
        glm::dvec4 out;
        for (int c = 0; c < 4; ++c) {
            const double byte = (word >> (8 * c) & 255u) / 255.0;
            const bool linear = c == 3 || (record.flags & TEXTURE_LINEAR);
            out[c] = linear ? byte : decoded_srgb(byte);
        }
        return out;
    };
    const glm::dvec2 at = uv * glm::dvec2(size[0], size[1]);
    TextureTexel out;
    if (record.flags & TEXTURE_NEAREST) {
        for (int c = 0; c < 2; ++c)
            out.near_border = out.near_border || std::abs(at[c] - std::round(at[c])) < slack;
        out.color = texel(std::floor(at.x), std::floor(at.y));
        return out;
    }
    // Texel centres lie at halves.
    const glm::dvec2 corner = glm::floor(at - 0.5), part = at - 0.5 - corner;
    out.color = glm::mix(
        glm::mix(texel(corner.x, corner.y), texel(corner.x + 1, corner.y), part.x),
        glm::mix(texel(corner.x, corner.y + 1), texel(corner.x + 1, corner.y + 1), part.x), part.y);
    return out;
}

// area: of UV space that one pixel covers. A level has one texel where level 0 has 4^level.
inline TextureTexel sampled_texture(const Textures& textures, int texture, const glm::dvec2& uv,
                                    double area, double slack = 1e-3) {
    const TextureRecord& record = textures.records[static_cast<std::size_t>(texture)];
    const int levels = static_cast<int>(record.flags >> TEXTURE_LEVELS_SHIFT);
    const double texels = area * record.width * record.height;
    const double level = std::min(0.5 * std::log2(std::max(texels, 1.0)), levels - 1.0);
    const int lower = static_cast<int>(level);
    TextureTexel out = level_texel(textures, record, lower, uv, slack);
    if (level == lower) return out;
    const TextureTexel coarse = level_texel(textures, record, lower + 1, uv, slack);
    return {glm::mix(out.color, coarse.color, level - lower),
            out.near_border || coarse.near_border};
}

}  // namespace clgi::test
