// Rows of transport are halves: what of a small site's row exceeds one is divided by a power of
// two.
//
//   T_ij A / 2^k <= 65504,   T_ij <= 2 / A_i                 [derived: the bound of
//   lights/disc.clh]
//
// A: the area of all sites. A disc sends at most 1 / A_i to a place for a power of 1. Samples near
// by are discs of a share of the area each, which tile the site; where they lie closer than even
// ones they send more, and twice as much is allowed for.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/vpl.h>
#include <cmath>
#include <cstdint>

namespace clgi {

constexpr double most_half = 65504.0;

// k of a site of this area; 0 for all but sites smaller than a 32752nd of the whole.
inline std::uint32_t row_exponent(double area, double all) {
    const double most = 2.0 * all / area;
    std::uint32_t out = 0;
    while (out < SITE_ROW_MOST && most > std::ldexp(most_half, static_cast<int>(out))) ++out;
    return out;
}

}  // namespace clgi
