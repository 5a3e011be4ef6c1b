// Where two pictures differ, and which of them is brighter there, as colours.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <vector>

#include "lab/mask.hpp"
#include "lab/raster.hpp"
#include "lab/scale_bar.hpp"

namespace clgi::lab {

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

struct DifferencePicture {
    Raster raster;
    Scale scale;  // to: what has the full colour
};

// Pixels that do not count are grey, those that are not finite in A or B magenta. The chosen scale
// is a round number; at most one pixel in a hundred has a larger difference. That of FLIP is 1.
// Throws InputError as compare does.
DifferencePicture difference_picture(const io::Image& a, const io::Image& b,
                                     const DifferenceOptions& options = {});

}  // namespace clgi::lab
