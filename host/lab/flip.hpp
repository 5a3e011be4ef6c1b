// FLIP: how different two pictures look to one who switches between them on a screen.
//
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: FLIP: A Difference Evaluator
// for Alternating Images, HPG 2020. Own code from the paper's definitions.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/io/image.hpp>
#include <vector>

namespace clgi::lab {

// A picture as a screen shows it.
struct Display {
    int width = 0;
    int height = 0;
    std::array<std::vector<float>, 3> rgb;  // [height][width], linear sRGB, 0 to 1
};

// Per pixel 0, alike, to 1. Of pictures of one size, at flip_pixels_per_degree; beyond their
// edges the outermost pixels repeat. [height][width]
std::vector<float> flip(const Display& a, const Display& b);

// ---- filters: what the eye resolves at a distance, and what it takes for edges and dots ---------

// A screen 0.7 m wide with 3840 pixels, seen from 0.7 m.
constexpr double flip_pixels_per_degree = 3840.0 * 3.14159265358979323846 / 180.0;

// weights[radius] is the middle.
struct Kernel {
    int radius = 0;
    std::vector<double> weights;  // [2 radius + 1]
};

// Applied along rows, then along columns. The two Gaussians of blue-yellow are separable one by
// one, their sum is not.
struct FlipFilters {
    int radius = 0;  // the largest of all
    Kernel achromatic;
    Kernel red_green;
    Kernel blue_yellow[2];
    double blue_yellow_share[2] = {};  // sum 1
    Kernel smooth;                     // sum 1
    Kernel edge;                       // first derivative: sums 1 and -1 by sign
    Kernel point;                      // second derivative: likewise
};

FlipFilters flip_filters(double pixels_per_degree = flip_pixels_per_degree);

// out[x] = sum over k of weights[radius + k] in[x + k stride]. in: readable radius steps beyond
// both ends. out: [count], no part of in
void filter(const Kernel& kernel, const double* in, int stride, double* out, int count);

// ---- pictures without an upper limit: the largest FLIP over a range of exposures ----------------

// Andersson, Nilsson, Shirley, Akenine-Moller: Visualizing Errors in Rendered High Dynamic Range
// Images, Eurographics 2021.

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
