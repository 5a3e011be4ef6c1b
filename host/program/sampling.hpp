// How the time of a picture is divided between its settings and its samples.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>

namespace clgi::program {

// Of one sample of a picture: by how much it errs, relative to the mean, and seconds that it takes.
struct Sampling {
    double error = 0.0, seconds = 0.0;
};

// The error of a picture whose settings err by so much, with as many samples as the seconds allow
// beside its first one: at worst their error falls as one over the root of their number.
inline double error_with_samples(double settings, const Sampling& one, double seconds) {
    const double count = 1.0 + std::max(0.0, seconds) / one.seconds;
    return std::hypot(settings, one.error / std::sqrt(count));
}

}  // namespace clgi::program
