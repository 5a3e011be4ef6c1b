// Parts of a triangle: itself, its quarters, and their quarters, by one number (PART_... of
// clgi/shared/moving_elements.h).
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/moving_elements.h>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace clgi {

constexpr int most_part_cuts = 2;

// Of the parts of a triangle that is cut so many times; those of one cut more begin where these
// end.
constexpr std::uint32_t first_part(int cuts) {
    return cuts == 0 ? 0u : cuts == 1 ? PART_QUARTERS : cuts == 2 ? PART_SIXTEENTHS : PART_END;
}

inline std::array<glm::dvec3, 3> quarter_of(const std::array<glm::dvec3, 3>& p,
                                            std::uint32_t quarter) {
    const glm::dvec3 m[3] = {0.5 * (p[0] + p[1]), 0.5 * (p[1] + p[2]), 0.5 * (p[2] + p[0])};
    switch (quarter) {
        case 0:
            return {p[0], m[0], m[2]};
        case 1:
            return {m[0], p[1], m[1]};
        case 2:
            return {m[2], m[1], p[2]};
        default:
            return {m[0], m[1], m[2]};
    }
}

inline std::array<glm::dvec3, 3> part_of(const std::array<glm::dvec3, 3>& p, std::uint32_t part) {
    if (part < PART_QUARTERS) return p;
    if (part < PART_SIXTEENTHS) return quarter_of(p, part - PART_QUARTERS);
    const std::uint32_t sixteenth = part - PART_SIXTEENTHS;
    return quarter_of(quarter_of(p, sixteenth / 4), sixteenth % 4);
}

}  // namespace clgi
