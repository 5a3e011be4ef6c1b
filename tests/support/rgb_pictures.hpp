// Small pictures in memory that are compared with each other.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <cstddef>
#include <functional>
#include <vector>

namespace rgb_pictures {

using clgi::io::Image;

inline Image picture(int width, int height, float red, float green, float blue) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Image image;
    image.width = width;
    image.height = height;
    image.channels = {{"R", std::vector<float>(pixels, red)},
                      {"G", std::vector<float>(pixels, green)},
                      {"B", std::vector<float>(pixels, blue)}};
    return image;
}

inline Image grey(int width, int height, float value) {
    return picture(width, height, value, value, value);
}

// sample(x, y, channel) for all.
inline Image drawn(int width, int height, const std::function<float(int, int, int)>& sample) {
    Image image = grey(width, height, 0.0f);
    for (int c = 0; c < 3; ++c) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                image.channels[static_cast<std::size_t>(c)]
                    .values[static_cast<std::size_t>(y * width + x)] = sample(x, y, c);
            }
        }
    }
    return image;
}

}  // namespace rgb_pictures
