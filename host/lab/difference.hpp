// Where two pictures differ, and which of them is brighter there, as colours whose distances match
// what the eye sees: both maps are drawn in OKLab (Ottosson 2020), where equal steps look equal.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/io/image.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lab/drawing.hpp"
#include "lab/mask.hpp"

namespace clgi::lab {

using Color = std::array<std::uint8_t, 3>;  // sRGB

// For signed values, -1 blue, 0 nearly white, +1 red: two straight lines, down in lightness and
// up in chroma, alike in both hues. Values outside are clamped.
Color diverging_color(double value);

// For sizes, 0 dark violet through blue and green to 1 light yellow: a helix of one chroma, so
// that lightness and hue rise evenly. Values outside are clamped.
Color sequential_color(double value);

// On neither map: pixels that do not count, and pixels with a NaN or an infinity.
constexpr Color uncounted_color = {160, 160, 160};
constexpr Color nonfinite_color = {255, 0, 255};

enum class Shown {
    difference,  // the mean of a-b over R, G and B: red where A is brighter, blue where B is
    size,        // the mean of |a-b|
    flip,        // HDR-FLIP
};

struct DifferenceOptions {
    Shown shown = Shown::difference;
    double scale = 0.0;                        // what has the full colour; 0: chosen
    const Mask* mask = nullptr;                // null: every pixel counts
    const std::vector<float>* flip = nullptr;  // hdr_flip of the pictures, if it is there already
};

// What the colours of a picture mean.
struct Scale {
    double from = 0.0;  // the value at the left end of a bar
    double to = 1.0;
    std::function<Color(double)> color;  // of a value from 0, the left end, to 1
    std::string caption;                 // what is measured
};

struct DifferencePicture {
    Raster raster;
    Scale scale;  // to: what has the full colour
};

// Pixels that do not count are grey, those that are not finite in A or B magenta. The chosen scale
// is a round number; at most one pixel in a hundred has a larger difference. That of FLIP is 1.
// Throws InputError as compare does.
DifferencePicture difference_picture(const io::Image& a, const io::Image& b,
                                     const DifferenceOptions& options = {});

// The picture on white paper with a bar below it that has the numbers of its colours; a narrow
// picture gets paper at both sides. Where no bar can be drawn, the picture alone, and a line on
// stderr that says why.
Raster with_scale_bar(const Raster& picture, const Scale& scale);

// The smallest of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below
// value, whose quarters have short labels; 0 for 0.
double round_up(double value);

}  // namespace clgi::lab
