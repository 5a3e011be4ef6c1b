// FLIP: how different two pictures look to one who switches between them on a screen.
//
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: FLIP: A Difference Evaluator
// for Alternating Images, HPG 2020. Own code from the paper's definitions.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
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

}  // namespace clgi::lab
