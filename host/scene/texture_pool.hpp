// All textures of a scene in one row of texels, with their mip levels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/scene.h>
#include <clgi/scene.hpp>
#include <vector>

namespace clgi {

struct TexturePool {
    std::vector<TextureRecord> records;
    std::vector<std::uint32_t> texels;  // RGBA8, red in the lowest byte
};

// Mip levels are averaged in linear light.
TexturePool make_texture_pool(const std::vector<Texture>& textures);

// The mip levels of one, from all of its size to 1x1.
std::vector<Texture> texture_levels(const Texture& texture);

// Linear value of every sRGB byte, IEC 61966-2-1. [256]
std::vector<float> srgb_decode_table();

// The nearest byte, by the same curve. Below 0 and not a number: 0; above 1: 255.
std::uint8_t srgb_byte(double linear);

}  // namespace clgi
