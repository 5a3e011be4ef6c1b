// What the colours of a picture mean: a bar below it, with the numbers that belong to them.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "lab/raster.hpp"

namespace clgi::lab {

struct Scale {
    double from = 0.0;  // the value at the left end
    double to = 1.0;
    std::function<Color(double)> color;  // of a value from 0, the left end, to 1
    std::string caption;                 // what is measured, in letters of lettering.hpp
};

// picture on white paper with the bar below; a narrow picture gets paper at both sides.
Raster with_scale_bar(const Raster& picture, const Scale& scale);

// The number as a tick's label, at most four digits: "0.25", "-3", "2e-7".
std::string tick_label(double value);

// The smallest of 1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8 times a power of ten that is not below
// value, whose quarters have short labels; 0 for 0.
double round_up(double value);

}  // namespace clgi::lab
