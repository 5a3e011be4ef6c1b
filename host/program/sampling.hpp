// How the time of a picture is divided between its settings and its samples.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

namespace clgi::program {

// By how much the mean of so many samples of a picture errs, relative to the mean, and seconds that
// each takes.
struct Sampling {
    double error = 0.0, count = 1.0, seconds = 0.0;
};

// Of so many samples, that come after the picture of the first and take so long together, the next
// one makes what those after it have: it counts where there is no other.
inline double seconds_each(double count, double next, double all) {
    return count > 2.0 ? (all - next) / (count - 2.0) : all;
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
