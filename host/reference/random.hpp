// Random numbers of their own for every pixel and sample, so that no thread disturbs another.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/halton.h>
#include <array>
#include <cstdint>

namespace clgi::reference {

class Random {
public:
    Random(std::uint64_t seed, std::uint64_t pixel, std::uint64_t sample)
        : state_(mixed(mixed(mixed(seed) ^ pixel) ^ sample)) {}

    // Of samples 0, 1, ... of a pixel the first numbers are even together: a Halton sequence,
    // shifted by other amounts for each pixel. Each sample alone is as random as others are, but
    // they are not independent.                                    [Cranley and Patterson 1976]
    static Random even(std::uint64_t seed, std::uint64_t pixel, std::uint32_t sample) {
        Random out(seed, pixel, sample);
        out.shifts_ = mixed(mixed(~seed) ^ pixel);
        out.index_ = sample;
        out.drawn_ = 0;
        return out;
    }

    std::uint64_t bits() {
        state_ += golden;
        return mixed(state_);
    }

    // [0,1), 24 bits.
    float operator()() {
        if (drawn_ == bases.size()) return unit(bits());
        const std::uint64_t shift = mixed(shifts_ + drawn_);
        return shifted_radical_inverse(index_, bases[drawn_++], unit(shift));
    }

private:
    static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15u;
    static constexpr std::array<std::uint32_t, 6> bases = {2, 3, 5, 7, 11, 13};

    static float unit(std::uint64_t x) { return static_cast<float>(x >> 40) * 0x1p-24f; }

    // The output function of SplitMix64 (Steele, Lea, Flood 2014).
    static std::uint64_t mixed(std::uint64_t x) {
        x += golden;
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
        return x ^ (x >> 31);
    }

    std::uint64_t state_;
    std::uint64_t shifts_ = 0;
    std::uint32_t index_ = 0;
    std::size_t drawn_ = bases.size();  // numbers of the sequence
};

}  // namespace clgi::reference
