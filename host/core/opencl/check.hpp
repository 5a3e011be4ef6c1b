// Checks of numbers that a caller gives.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/error.hpp>
#include <string>

namespace clgi {

// Throws Error unless low <= value <= high; a number that is none is out of every range.
template <typename Number>
void need_range(const char* owner, const char* name, Number value, Number low, Number high) {
    if (!(value >= low && value <= high))
        throw Error(std::string(owner) + ": " + name + " is " + std::to_string(value) + ", " +
                    std::to_string(low) + " to " + std::to_string(high) + " needed");
}

}  // namespace clgi
