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
// has no points.
struct Speedup {
    std::string method;
    double at_least_error = 0.0;  // at the cheapest error within a tenth of the least it reaches
    double least_error = 0.0;
    double best = 0.0;  // anywhere on its front
    double best_error = 0.0;
};
Speedup speedup(const Sweep& sweep, const std::string& method, int truth);

std::vector<std::string> summary(const Sweep& sweep);

}  // namespace clgi::report
