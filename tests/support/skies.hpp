// Environments put together by hand, and what they send by closed forms.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "scenes.hpp"

namespace clgi::test {

inline Environment even_sky(const glm::vec3& radiance) {
    Environment sky;
    sky.factor = radiance;
    return sky;
}

// value(row, column) of every texel.
inline Environment picture_sky(int width, int height,
                               const std::function<float(int row, int column)>& value) {
    Environment sky;
    sky.width = width;
    sky.height = height;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) sky.texels.emplace_back(value(row, column));
    return sky;
}

// (1 + y) / 2, each row with its mean. Irradiance of a plane with normal n: pi/2 + pi/3 n.y
inline Environment gradient_sky(int width = 8, int height = 256) {
    return picture_sky(width, height, [&](int row, int) {
        const double upper = std::cos(std::numbers::pi * row / height);
        const double lower = std::cos(std::numbers::pi * (row + 1) / height);
        return static_cast<float>(0.5 + 0.25 * (upper + lower));
    });
}

// Uneven everywhere, in every channel: by factors of up to e^(2 steps).
inline Environment rough_sky(int width, int height, double steps = 3.0) {
    Random random(7);
    Environment sky = picture_sky(width, height, [](int, int) { return 0.0f; });
    for (glm::vec3& texel : sky.texels)
        for (int c = 0; c < 3; ++c) texel[c] = static_cast<float>(std::exp(random(-steps, steps)));
    sky.factor = {1.0f, 0.5f, 2.0f};
    return sky;
}

// A block of texels in angles: from +Y, and from the picture's left edge.
struct SkyBlock {
    double top, bottom, left, right;
};

inline SkyBlock block_of(const Environment& sky, int row, int rows, int column, int columns) {
    const double down = std::numbers::pi / sky.height, across = 2 * std::numbers::pi / sky.width;
    return {row * down, (row + rows) * down, column * across, (column + columns) * across};
}

inline double solid_angle(const SkyBlock& block) {
    return (std::cos(block.top) - std::cos(block.bottom)) * (block.right - block.left);
}

// The integral of directions over a block: with a normal, irradiance where all of it is in front.
inline glm::dvec3 vector_of(const SkyBlock& block, double rotation = 0.0) {
    const double level =
        0.5 * (std::pow(std::sin(block.bottom), 2) - std::pow(std::sin(block.top), 2));
    const double ring = 0.5 * (block.bottom - block.top) -
                        0.25 * (std::sin(2 * block.bottom) - std::sin(2 * block.top));
    const double left = block.left - std::numbers::pi - rotation;
    const double right = block.right - std::numbers::pi - rotation;
    return {ring * (std::cos(left) - std::cos(right)), level * (right - left),
            -ring * (std::sin(right) - std::sin(left))};
}

}  // namespace clgi::test
