// From pixels drawn at random to the error of the whole picture, with a confidence interval.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>
#include <cstddef>
#include <vector>

namespace clgi::reference {

// A pixel drawn from a stratum. All numbers are weighted so that their mean over draws of a
// stratum, and then over strata, is expected to be the mean over the picture.
struct Draw {
    std::size_t stratum = 0;
    double square = 0.0;   // (x - truth)^2, without the noise of the truth; may be negative
    double light = 0.0;    // luminance of the truth
    double picture = 0.0;  // luminance of the picture
};

struct ErrorAndEnergy {
    Estimate error;
    Estimate energy;
};

// draws: by rising stratum, at least two of each. picture: the mean luminance of all pixels.
ErrorAndEnergy estimate(const std::vector<Draw>& draws, double picture);

// That a Student t of so many degrees of freedom, at least 1, exceeds in one case of forty: at most
// 4 % too large.
double student_t(double degrees);

}  // namespace clgi::reference
