// SPDX-License-Identifier: MIT
#include "scene/texture_pool.hpp"

#include <algorithm>
#include <cmath>

namespace clgi {
namespace {

double decode_srgb(double s) {
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// Between bytes and linear light, by the curve of one texture. Encoding by table: nearest of 4096
// steps is well within half a byte's width.
class ByteCurve {
public:
    explicit ByteCurve(bool srgb) : decode_(srgb_decode_table()), bytes_(4097) {
        for (int i = 0; !srgb && i < 256; ++i) decode_[i] = static_cast<float>(i / 255.0);
        for (int i = 0; i <= 4096; ++i) {
            const double linear = i / 4096.0;
            bytes_[i] = srgb ? srgb_byte(linear) : static_cast<std::uint8_t>(linear * 255.0 + 0.5);
        }
    }
    float decode(std::uint32_t byte) const { return decode_[byte & 255]; }
    std::uint32_t encode(float linear) const {
        return bytes_[static_cast<int>(std::clamp(linear, 0.0f, 1.0f) * 4096.0f + 0.5f)];
    }

private:
    std::vector<float> decode_;
    std::vector<std::uint32_t> bytes_;
};

struct Level {
    int width, height;
    std::vector<std::uint32_t> texels;
};

struct Tap {
    int texel;
    float weight;  // sum 1 over a texel's taps
};

// The texels of an axis that each texel of half the size covers, by how much: two, or three where
// the size is odd.
std::vector<std::vector<Tap>> box_taps(int size, int half) {
    std::vector<std::vector<Tap>> taps(half);
    const double step = static_cast<double>(size) / half;
    for (int i = 0; i < half; ++i)
        for (int t = static_cast<int>(i * step); t < size && t < (i + 1) * step; ++t) {
            const double covered =
                std::min(t + 1.0, (i + 1) * step) - std::max<double>(t, i * step);
            if (covered > 1e-9) taps[i].push_back({t, static_cast<float>(covered / step)});
        }
    return taps;
}

Level halve(const Level& level, const ByteCurve& curve) {
    Level out{std::max(level.width / 2, 1), std::max(level.height / 2, 1), {}};
    out.texels.reserve(static_cast<std::size_t>(out.width) * out.height);
    const auto columns = box_taps(level.width, out.width);
    const auto rows = box_taps(level.height, out.height);
    for (const auto& row : rows)
        for (const auto& column : columns) {
            float rgb[3] = {0, 0, 0};
            float alpha = 0.5f;
            for (const Tap& y : row)
                for (const Tap& x : column) {
                    const std::uint32_t t =
                        level.texels[static_cast<std::size_t>(y.texel) * level.width + x.texel];
                    const float weight = x.weight * y.weight;
                    for (int c = 0; c < 3; ++c) rgb[c] += weight * curve.decode(t >> (8 * c));
                    alpha += weight * static_cast<float>(t >> 24);
                }
            out.texels.push_back(curve.encode(rgb[0]) | curve.encode(rgb[1]) << 8 |
                                 curve.encode(rgb[2]) << 16 |
                                 static_cast<std::uint32_t>(alpha) << 24);
        }
    return out;
}

std::uint32_t wrap_bits(Wrap wrap) {
    return wrap == Wrap::repeat ? 0 : wrap == Wrap::mirrored_repeat ? 1 : 2;
}

Level first_level(const Texture& texture) {
    Level level{texture.width, texture.height, {}};
    level.texels.resize(static_cast<std::size_t>(texture.width) * texture.height);
    for (std::size_t i = 0; i < level.texels.size(); ++i)
        for (int c = 0; c < 4; ++c)
            level.texels[i] |= std::uint32_t{texture.rgba[4 * i + c]} << (8 * c);
    return level;
}

std::vector<Level> levels_of(const Texture& texture, const ByteCurve& curve) {
    std::vector<Level> out{first_level(texture)};
    while (out.back().width > 1 || out.back().height > 1) out.push_back(halve(out.back(), curve));
    return out;
}

}  // namespace

std::vector<Texture> texture_levels(const Texture& texture) {
    std::vector<Texture> out;
    for (const Level& level : levels_of(texture, ByteCurve(texture.srgb))) {
        Texture as{texture.name,   level.width,    level.height,    {},
                   texture.wrap_s, texture.wrap_t, texture.nearest, texture.srgb};
        as.rgba.reserve(4 * level.texels.size());
        for (const std::uint32_t texel : level.texels)
            for (int c = 0; c < 4; ++c)
                as.rgba.push_back(static_cast<std::uint8_t>(texel >> (8 * c) & 255));
        out.push_back(std::move(as));
    }
    return out;
}

std::uint8_t srgb_byte(double linear) {
    const double v = linear > 0.0 ? std::min(linear, 1.0) : 0.0;  // not a number is black
    const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(s * 255.0 + 0.5);
}

std::vector<float> srgb_decode_table() {
    std::vector<float> table(256);
    for (int i = 0; i < 256; ++i) table[i] = static_cast<float>(decode_srgb(i / 255.0));
    return table;
}

TexturePool make_texture_pool(const std::vector<Texture>& textures) {
    TexturePool pool;
    if (textures.empty()) return pool;
    const ByteCurve srgb(true), linear(false);
    for (const Texture& texture : textures) {
        TextureRecord record{};
        record.first_texel = static_cast<std::uint32_t>(pool.texels.size());
        record.width = texture.width;
        record.height = texture.height;
        const std::vector<Level> levels = levels_of(texture, texture.srgb ? srgb : linear);
        for (const Level& level : levels)
            pool.texels.insert(pool.texels.end(), level.texels.begin(), level.texels.end());
        record.flags = wrap_bits(texture.wrap_s) | wrap_bits(texture.wrap_t) << 2 |
                       (texture.nearest ? std::uint32_t{TEXTURE_NEAREST} : 0u) |
                       (texture.srgb ? 0u : std::uint32_t{TEXTURE_LINEAR}) |
                       static_cast<std::uint32_t>(levels.size()) << TEXTURE_LEVELS_SHIFT;
        pool.records.push_back(record);
    }
    return pool;
}

}  // namespace clgi
