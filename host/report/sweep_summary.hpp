// What a sweep says in sentences.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "report/sweep.hpp"

namespace clgi::report {

// Where a curve over one knob stops falling: what is left is the method's bias.
struct Floor {
    std::string setting;  // of the knob, the cheapest that is within a tenth of the least error
    double error = 0.0;
};
Floor floor_of(const Sweep& sweep, const std::string& series, const std::string& knob, int truth);

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
Speedup speedup(const Sweep& sweep, const std::string& method, int truth);

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

std::vector<std::string> summary(const Sweep& sweep);

}  // namespace clgi::report
