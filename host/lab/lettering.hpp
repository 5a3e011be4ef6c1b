// The letters that scales and captions need, drawn as strokes: sharp at every size.
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "lab/raster.hpp"

namespace clgi::lab {

constexpr Color paper = {255, 255, 255}, ink = {40, 40, 40};

// Known are 0 to 9, a to z, "+-.,:%|", "A", "B", "F", "L", "I", "P" and the space; others leave a
// gap.
// height: of a digit, in pixels.
double text_width(std::string_view text, double height);

// left, top: of the first digit, in pixels.
void draw_text(Raster& raster, std::string_view text, double left, double top, double height,
               const Color& color);

}  // namespace clgi::lab
