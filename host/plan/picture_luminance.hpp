// Luminance of a solver's picture, and how far two pictures are apart.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/second_order.hpp>
#include <vector>

namespace clgi {

// cd/m^2 of every pixel, row by row; waits for `done`, the event of the picture.
std::vector<double> picture_luminance(const cl::CommandQueue& queue,
                                      const SecondOrderSolver& solver, const cl::Event& done);

// Both 0 for no pixels.
CLGI_API double mean(const std::vector<double>& values);
double mean_square_difference(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace clgi
