// FLIP of pictures without an upper limit: the largest FLIP over a range of exposures.
//
// Andersson, Nilsson, Shirley, Akenine-Moller: Visualizing Errors in Rendered High Dynamic Range
// Images, Eurographics 2021.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <vector>

namespace clgi::lab {

// Factors from the one that shows the brightest pixel to the one that shows a median pixel, in
// steps of about one stop.
struct Exposures {
    double first = 1.0;
    double last = 1.0;
    int count = 0;  // 0: there is no light in the picture

    double at(int i) const;
};
Exposures exposures(const io::Image& picture);

// Per pixel 0, alike, to 1. Non-finite samples are replaced as load_image does, negative ones
// count as 0. Throws InputError as compare does. [height][width]
std::vector<float> hdr_flip(const io::Image& a, const io::Image& b);

}  // namespace clgi::lab
