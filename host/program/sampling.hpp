// How the time of a picture is divided between its settings and its samples.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace clgi::program {

// By how much the mean of so many samples of a picture errs, relative to the mean, and seconds that
// each takes.
struct Sampling {
    double error = 0.0, count = 1.0, seconds = 0.0;
};

// How long samples take, by as many as were made, of which up to four are known, the last one
// first: the least mean of two in a row. Every second one may draw shadow maps; the first four of a
// picture have their directions of the sky in parts, which takes longer, and one that something
// else held up is no measure of others.
inline double time_each(const std::array<double, 4>& before, std::size_t count) {
    if (count < 2) return before[0];
    double out = std::numeric_limits<double>::max();
    for (std::size_t k = 1; k < std::min(count, before.size()); ++k)
        out = std::min(out, 0.5 * (before[k - 1] + before[k]));
    return out;
}

// How long the next sample takes, at most, by those before it: the last one, the one before and
// the one four before. The first makes what those after it have, and is no measure of them where
// one of another picture is known (each).
inline double next_sample(const std::array<double, 3>& before, std::size_t count, double each) {
    constexpr double slower = 2.0;
    if (count == 1 && each > 0.0) return std::min(before[0], slower * each);
    return *std::max_element(before.begin(), before.end());
}

// The error of a picture whose settings err by so much, with as many samples as the seconds allow
// beside its first one. What edges, textures and lobes leave falls faster than one over the root of
// their number, by about this power of it (docs/results/irradiance-cache.md).
inline double error_with_samples(double settings, const Sampling& found, double seconds) {
    constexpr double power = 0.65;
    const double count = 1.0 + std::max(0.0, seconds) / found.seconds;
    return std::hypot(settings, found.error * std::pow(found.count / count, power));
}

}  // namespace clgi::program
