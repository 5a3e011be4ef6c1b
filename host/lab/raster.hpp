// An 8-bit picture to be saved as PNG.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lab/color_map.hpp"

namespace clgi::lab {

struct Raster {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  // [height][width][4], sRGB, row 0 at the top

    Raster() = default;
    Raster(int w, int h, const Color& paper) : width(w), height(h) {
        const auto pixels = static_cast<std::size_t>(w) * static_cast<std::size_t>(h);
        rgba.reserve(4 * pixels);
        for (std::size_t i = 0; i < pixels; ++i) {
            rgba.insert(rgba.end(), {paper[0], paper[1], paper[2], 255});
        }
    }

    std::uint8_t* at(int x, int y) {
        return rgba.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                  static_cast<std::size_t>(x));
    }

    // Nothing happens outside. coverage 0 to 1
    void paint(int x, int y, const Color& color, double coverage = 1.0) {
        if (x < 0 || y < 0 || x >= width || y >= height) return;
        std::uint8_t* pixel = at(x, y);
        for (std::size_t c = 0; c < 3; ++c) {
            pixel[c] =
                static_cast<std::uint8_t>(std::lround(pixel[c] + coverage * (color[c] - pixel[c])));
        }
    }
    // A picture that lies within this one, its corner at left, top.
    void put(const Raster& picture, int left, int top) {
        const std::size_t row_bytes = 4 * static_cast<std::size_t>(picture.width);
        for (int y = 0; y < picture.height; ++y)
            std::copy_n(picture.rgba.data() + row_bytes * static_cast<std::size_t>(y), row_bytes,
                        at(left, top + y));
    }
    void fill(int x, int y, int w, int h, const Color& color) {
        for (int row = y; row < y + h; ++row) {
            for (int column = x; column < x + w; ++column) paint(column, row, color);
        }
    }
};

}  // namespace clgi::lab
