// A sweep of antiradiance: the settings that it tries, and what it says.   [Dachsbacher07]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/antiradiance.hpp>

#include "lab/picture_methods.hpp"

namespace clgi::lab {

std::string name_of(Iteration iteration);  // "auto", as --iteration has it

// By series: the knob that is varied alone, from the least accurate value on, or "grid". Those of a
// sweep of antiradiance alone, or quick ones beside other systems.
std::vector<PictureSetting> antiradiance_settings(bool quick, const BuildOptions& build = {},
                                                  bool alone = true);

// How the estimated errors of settings with different numbers of bins compare with the true ones:
// the least and the greatest ratio of estimated to true error. Zeros where there are none.
struct EstimateQuality {
    double least = 0.0, most = 0.0;
};
EstimateQuality estimate_quality(const Sweep& sweep, std::size_t truth);

}  // namespace clgi::lab
