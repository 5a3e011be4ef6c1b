// Random numbers of their own for every pixel and sample, so that no thread disturbs another.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace clgi::reference {

class Random {
public:
    Random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
        : state_(mixed(mixed(mixed(seed) ^ pixel) ^ sample)) {}

    std::uint64_t bits() {
        state_ += golden;
        return mixed(state_);
    }

    // [0,1), 24 bits.
    float operator()() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }

private:
    static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;

    // The output function of SplitMix64 (Steele, Lea, Flood 2014).
    static std::uint64_t mixed(std::uint64_t x) {
        x += golden;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }

    std::uint64_t state_;
};

}  // namespace clgi::reference
