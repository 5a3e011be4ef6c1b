// Counts that the second-order solver and its memory agree on.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>

namespace clgi::second_order {

// Throws Error naming the option that is out of range.
void check(const SecondOrderOptions& options);

// Whether a frame is lit at low resolution first.
bool refines(const SecondOrderOptions& options);

std::size_t pixel_count(const SecondOrderOptions& options);
std::size_t low_pixel_count(const SecondOrderOptions& options);

// Floats from plane to plane: a multiple of 16, so that every packet stays inside its plane.
std::uint32_t padded(std::size_t count);

}  // namespace clgi::second_order
