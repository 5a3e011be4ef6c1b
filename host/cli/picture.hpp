// From a finished frame to files.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>
#include <optional>
#include <string>

namespace clgi::cli {

struct PictureFlags {
    std::string exr;                // empty: none
    std::string png;                // empty: none
    bool full = false;              // 32-bit EXR channels instead of half
    std::optional<float> exposure;  // stops, 0: radiance 1 is white; none: from the picture
};

// Reads the solver's radiance back and writes what was asked for.
void save_picture(const cl::CommandQueue& queue, const SecondOrderSolver& solver,
                  const PictureFlags& flags);

}  // namespace clgi::cli
