// Frame times and what they come down to.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>
#include <functional>
#include <string>
#include <vector>

namespace clgi::report {

struct Spread {
    double min = 0.0;
    double median = 0.0;
    double max = 0.0;
};

// Of any number of values; all zero for none.
Spread spread(std::vector<double> values);

// Renders one frame and waits for it. Milliseconds on the host's clock, nothing transferred.
double time_frame(SecondOrderSolver& solver, const cl::CommandQueue& queue, const Camera& camera);

// The same of any frame that `enqueue` puts on the queue.
double time_frame(const cl::CommandQueue& queue, const std::function<void()>& enqueue);

struct PassTime {
    std::string name;
    double milliseconds = 0.0;  // on the device, all launches of the frame together
    std::size_t items = 0;
};

// Device times of a finished frame by pass, in order of first launch. Needs a profiling queue.
std::vector<PassTime> pass_times(const SecondOrderSolver& solver);
std::vector<PassTime> pass_times(const std::vector<PassEvent>& events);

}  // namespace clgi::report
