// Where two pictures differ, and which of them is brighter there, as colours.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/io/image.hpp>
#include <cstdint>
#include <vector>

namespace clgi::report {

struct DifferencePicture {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  // [height][width][4], sRGB, row 0 at the top
    double scale = 0.0;              // the difference that has the full colour
};

// The mean of a-b over R, G and B: red where A is brighter, blue where B is, nearly white where
// they agree. scale 0: chosen, so that one pixel in a hundred has a larger difference.
// Throws InputError as compare does.
DifferencePicture difference_picture(const io::Image& a, const io::Image& b, double scale = 0.0);

// -1 blue, 0 nearly white, +1 red; equal steps look equal. Values outside are clamped.
std::array<std::uint8_t, 3> diverging_color(double value);

}  // namespace clgi::report
