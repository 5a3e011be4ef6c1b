// SPDX-License-Identifier: MIT
#include "lab/mask.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cstdint>
#include <string>

namespace clgi::lab {
namespace {

std::size_t pixels_of(int width, int height) {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

std::string size_text(int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
}

void count(Mask& mask) {
    mask.pixels = static_cast<std::size_t>(std::count(mask.counts.begin(), mask.counts.end(), 1));
}

bool fits(int first, int length, int whole) {
    return first >= 0 && length >= 1 && std::int64_t{first} + length <= whole;
}

}  // namespace

Mask whole_picture(int width, int height) {
    const std::size_t pixels = pixels_of(width, height);
    return {width, height, std::vector<std::uint8_t>(pixels, 1), pixels};
}

Mask mask_of(const io::Image& image) {
    Mask mask{image.width, image.height, {}, 0};
    mask.counts.assign(pixels_of(image.width, image.height), 0);
    for (const io::Image::Channel& channel : image.channels) {
        if (channel.name == "A" && image.channels.size() > 1) continue;
        for (std::size_t i = 0; i < mask.counts.size(); ++i) {
            if (channel.values[i] != 0.0f) mask.counts[i] = 1;
        }
    }
    if (const io::Image::Channel* alpha = image.find("A")) {
        for (std::size_t i = 0; i < mask.counts.size(); ++i) {
            if (alpha->values[i] == 0.0f) mask.counts[i] = 0;
        }
    }
    count(mask);
    return mask;
}

Mask within(const Mask& mask, const Region& region) {
    if (!fits(region.x, region.width, mask.width) || !fits(region.y, region.height, mask.height)) {
        throw InputError("compare: the region of " + size_text(region.width, region.height) +
                         " pixels at " + std::to_string(region.x) + "," + std::to_string(region.y) +
                         " does not lie in the picture of " + size_text(mask.width, mask.height));
    }
    Mask inside{mask.width, mask.height, {}, 0};
    inside.counts.assign(mask.counts.size(), 0);
    for (int y = region.y; y < region.y + region.height; ++y) {
        const auto first = static_cast<std::ptrdiff_t>(pixels_of(mask.width, y)) + region.x;
        std::copy_n(mask.counts.begin() + first, region.width, inside.counts.begin() + first);
    }
    count(inside);
    return inside;
}

void check_mask(const Mask& mask, int width, int height) {
    if (mask.width != width || mask.height != height) {
        throw InputError("compare: the mask has " + size_text(mask.width, mask.height) +
                         " pixels, the pictures have " + size_text(width, height));
    }
    if (mask.pixels == 0) throw InputError("compare: the mask selects no pixel");
}

}  // namespace clgi::lab
