// What path-traced samples say of a pixel of a picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "reference/interval.hpp"
#include "reference/pixel_draws.hpp"

namespace clgi::reference {

// A pixel and the samples that were taken of it, in turn by groups: those of a group are even
// together, and independent of the other groups'.
struct Traced {
    static constexpr std::size_t groups = 8;

    DrawnPixel drawn;
    double picture = 0.0;     // luminance
    std::uint32_t taken = 0;  // samples, those left out included
    std::uint32_t non_finite = 0;
    std::array<double, groups> sums{};  // of picture - sample
    std::array<std::uint32_t, groups> counts{};

    // luminance_of(group, number within it)
    template <typename Luminance>
    void add(const Luminance& luminance_of) {
        const std::size_t group = taken % groups;
        const double difference =
            picture - luminance_of(group, taken++ / static_cast<std::uint32_t>(groups));
        if (!std::isfinite(difference)) {
            ++non_finite;
            return;
        }
        sums[group] += difference;
        ++counts[group];
    }

    double count() const { return double(taken) - double(non_finite); }
    double light() const {
        const double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
        return count() > 0.0 ? picture - sum / count() : picture;
    }
    // Of one sample, as if all were independent.
    double variance() const {
        const Means all = means();
        if (all.used < 2.0) return 0.0;
        const double between = std::max(all.square - all.sum * all.sum / all.used, 0.0);
        return between / (all.used - 1.0) * count() / all.used;
    }
    // The mean of (x - a)(x - b), a and b the means of different groups.
    double squared_error() const {
        const Means all = means();
        if (all.used < 2.0) return 0.0;
        return (all.sum * all.sum - all.square) / (all.used * (all.used - 1.0));
    }
    Draw weighted() const {
        return {drawn.stratum, drawn.weight * squared_error(), drawn.weight * light(),
                drawn.weight * picture};
    }

private:
    struct Means {
        double used = 0.0, sum = 0.0, square = 0.0;
    };

    Means means() const {
        Means out;
        for (std::size_t g = 0; g < groups; ++g) {
            if (counts[g] == 0) continue;
            const double mean = sums[g] / counts[g];
            out.used += 1.0;
            out.sum += mean;
            out.square += mean * mean;
        }
        return out;
    }
};

}  // namespace clgi::reference
