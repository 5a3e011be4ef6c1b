// Times of frames on the host's clock, and what they come down to.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <clgi/advanced/export.hpp>
#include <clgi/opencl.hpp>
#include <functional>
#include <vector>

namespace clgi::timing {

using Clock = std::chrono::steady_clock;

inline double milliseconds(Clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}

struct Spread {
    double min = 0.0;
    double median = 0.0;
    double max = 0.0;
};

// Of any number of values; all zero for none.
CLGI_API Spread spread(std::vector<double> values);

// Milliseconds until all that `enqueue` puts on the queue is done. Nothing is transferred.
CLGI_API double time_frame(const cl::CommandQueue& queue, const std::function<void()>& enqueue);

}  // namespace clgi::timing
