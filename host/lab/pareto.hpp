// What is worth its time: fronts of error against milliseconds.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace clgi::lab {

struct Cost {
    double milliseconds;
    double error;
};

// Indices of the points that no other beats in both, by time. Points of equal cost: the first.
std::vector<std::size_t> pareto_front(const std::vector<Cost>& points);

// The time at which a curve reaches an error: along straight lines in log-log, beyond its last
// point by the root of time, as unbiased noise falls. Nothing for an empty curve.
// curve: by time, errors above 0.
std::optional<double> time_to_reach(const std::vector<Cost>& curve, double error);

}  // namespace clgi::lab
