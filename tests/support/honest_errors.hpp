// What the path tracer says of its own error, against the error that it has.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <clgi/reference.hpp>
#include <cmath>
#include <vector>

namespace clgi::test {

// Direct light of a place again and again: the errors stated are those from what is wanted, lux of
// red, and halve with four times the samples.
inline void expect_honest_errors(const reference::PathTracer& tracer, const reference::Place& place,
                                 double wanted) {
    const std::vector<reference::Place> places(4000, place);
    double before = 0.0;
    for (const int samples : {16, 64, 256}) {
        reference::Options options;
        options.effects = reference::parse_effects("direct");
        options.samples = samples;
        const reference::Irradiance found = tracer.irradiance(places, options);
        double square = 0.0, said = 0.0;
        for (std::size_t i = 0; i < places.size(); ++i) {
            square += std::pow(double{found.values[i].x} - wanted, 2);
            said += std::pow(double{found.error[i]}, 2);
        }
        // 4,000 deviates fix a standard deviation to 1.1 %; 5 of those.
        EXPECT_NEAR(std::sqrt(said / square), 1.0, 0.055) << samples;
        if (before > 0.0) {
            EXPECT_NEAR(std::sqrt(before / square), 2.0, 0.16) << samples;
        }
        before = square;
    }
}

}  // namespace clgi::test
