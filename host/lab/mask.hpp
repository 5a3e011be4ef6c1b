// Which pixels of a picture count.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clgi::lab {

struct Mask {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> counts;  // [height][width], 0 or 1
    std::size_t pixels = 0;            // how many are 1

    bool operator[](std::size_t pixel) const { return counts[pixel] != 0; }
};

// Pixels, the corner at the top left first.
struct Region {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

Mask whole_picture(int width, int height);

// Pixels of which some channel is not zero. A channel A decides alone where it is zero: what is
// fully transparent never counts. NaN is not zero.
Mask mask_of(const io::Image& image);

// Those pixels of mask that lie in region. Throws InputError when region is empty or reaches
// outside the picture.
Mask within(const Mask& mask, const Region& region);

// Throws InputError when mask is of another size or selects nothing.
void check_mask(const Mask& mask, int width, int height);

}  // namespace clgi::lab
