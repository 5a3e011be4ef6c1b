// What every solver says of its last result.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace clgi {

struct SolverStatus {
    // What is iterated has come to rest below the bound of the options. True for what is not.
    bool converged = true;
    // There is no result: the iteration diverged, and pictures show direct light alone.
    bool given_up = false;
    // Packets of numbers that were not finite and were replaced.
    std::uint32_t non_finite = 0;
};

}  // namespace clgi
