// What a sweep says in sentences.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "lab/sweep.hpp"

namespace clgi::lab {

std::vector<const SweepPoint*> points_of(const Sweep& sweep, const std::string& series);

// Where a curve over one knob stops falling: what is left is the method's bias.
struct Floor {
    std::string setting;  // of the knob, the cheapest that is within a tenth of the least error
    double error = 0.0;
};
Floor floor_of(const Sweep& sweep, const std::string& series, const std::string& knob,
               std::size_t truth);

// How many times faster a method reaches its own error than the path tracer does. 0 when either
// has no points. Below `measured_to`, the least error that was measured of the path tracer, its
// time is extrapolated by time_to_reach.
struct Speedup {
    std::string method;
    double at_least_error = 0.0;  // at the cheapest error within a tenth of the least it reaches
    double least_error = 0.0;
    double best = 0.0;  // anywhere on its front
    double best_error = 0.0;
    double measured_to = 0.0;
};
Speedup speedup(const Sweep& sweep, const std::string& method, std::size_t truth);
// The knob that a series varies: its name up to the comma.
std::string knob_of(const std::string& series);
// A sentence about a series, with the errors against some truths; and one about what was done once
// before all frames, which begins with `once`, where there was something. Nothing for no points.
void add_series(const Sweep& sweep, const std::string& series,
                const std::vector<std::size_t>& truths, const std::string& once,
                std::vector<std::string>& out);

// What a way of building the kernels gains and costs: the points of the series "math".
struct MathMode {
    std::string math;     // "strict", "fast"
    std::string storage;  // "full", "half"
    double milliseconds = 0.0;
    double speed = 0.0;       // times as fast as strict math on floats
    double error = 0.0;       // against one bounce
    double difference = 0.0;  // relative_error() against the picture of strict math on floats
};
std::vector<MathMode> math_modes(const Sweep& sweep);

// A setting of a method on its front, and the quickest measured one of another method that is at
// least as accurate. No interpolation, so the factor is not flattered.
struct AtEqualError {
    const SweepPoint* slow = nullptr;
    const SweepPoint* quick = nullptr;
    double factor = 0.0;  // how many times less time the quick one takes
};
// slow, quick: methods. By time of the slow one; settings that the quick method cannot match are
// left out.
std::vector<AtEqualError> at_equal_error(const Sweep& sweep, const std::string& slow,
                                         const std::string& quick, std::size_t truth);

// How the estimated errors of antiradiance with different numbers of bins compare with the true
// ones: the least and the greatest ratio of estimated to true error. Zeros where there are none.
struct EstimateQuality {
    double least = 0.0, most = 0.0;
};
EstimateQuality estimate_quality(const Sweep& sweep, std::size_t truth);

std::vector<std::string> summary(const Sweep& sweep);

}  // namespace clgi::lab
