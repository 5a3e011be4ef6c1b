// How long passes over many lights are cut into dispatches, and dealt to several devices.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/opencl.hpp>
#include <cstddef>
#include <vector>

namespace clgi {

// Pairs of a point and a light that the device takes in a second: a rough guess from clock, units
// and lanes. An estimate() of a frame builds on it.
double pairs_per_second(const cl::Device& device);

// That of the device on which predicted times were fitted.
constexpr double fitted_pairs = 5.0e9;

struct Share {
    std::size_t worker;
    Range range;
};

// Items 0 .. count - 1, each of which costs `pairs` pairs, as dispatches of about 100 ms at most by
// the workers' speeds; in order, and each dispatch given to the worker that would be done with it
// first. A single worker that needs no more than one dispatch gets one whole range.
std::vector<Share> deal(std::size_t count, double pairs, const std::vector<double>& speeds);

}  // namespace clgi
