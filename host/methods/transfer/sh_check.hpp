// What functions of spherical harmonics refuse.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/sh.hpp>
#include <clgi/error.hpp>
#include <string>

namespace clgi::sh {

inline void need_bands(int bands) {
    if (bands < 1 || bands > most_bands)
        throw Error("sh: " + std::to_string(bands) + " bands, 1 to " + std::to_string(most_bands) +
                    " needed");
}

}  // namespace clgi::sh
