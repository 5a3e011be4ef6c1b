// One number for how far a picture is from the truth, the truth's own noise taken out.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>

#include "lab/mask.hpp"

namespace clgi::lab {

// sqrt(mean (Y_a - Y_b)^2 - mean e_b^2) / mean Y_b, Y the luminance and e_b the standard error
// that picture B states in its plane error.Y, if it has one. 0 where noise explains all.
// mask: the pixels that count; null: all. Throws InputError when sizes differ, R, G or B is missing
// or no pixel counts.
double relative_error(const io::Image& a, const io::Image& b, const Mask* mask = nullptr);

// Mean luminance of a over that of b, over the same pixels.
double luminance_ratio(const io::Image& a, const io::Image& b, const Mask* mask = nullptr);

}  // namespace clgi::lab
