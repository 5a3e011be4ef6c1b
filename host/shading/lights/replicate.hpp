// Randomised replicates of low-discrepancy points.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace clgi {

enum class ShiftUse : std::uint32_t {
    light = 0,
    area = 4,
    image = 6,
    stratum = 8,
    texel = 10,
    environment = 12
};

// The shift of one dimension of one use in a replicate, [0,1): even, and independent of all
// others. Replicate 0 is the sequence itself: no shift.
inline float replicate_shift(std::uint32_t replicate, ShiftUse use, std::uint32_t dimension) {
    if (replicate == 0) return 0.0f;
    // The output function of SplitMix64 (Steele, Lea, Flood 2014).
    std::uint64_t x = (std::uint64_t{replicate} << 8) + static_cast<std::uint32_t>(use) + dimension;
    x *= 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return static_cast<float>((x ^ (x >> 31)) >> 40) * 0x1p-24f;
}

}  // namespace clgi
