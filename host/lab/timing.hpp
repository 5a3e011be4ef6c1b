// Frame times, what they come down to, and what a device can do at most.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/recorder.hpp>
#include <string>
#include <vector>

#include "core/opencl/timing.hpp"

namespace clgi::lab {

using timing::Clock;
using timing::milliseconds;
using timing::Spread;
using timing::spread;
using timing::time_frame;

struct PassTime {
    std::string name;
    double milliseconds = 0.0;  // on the device, all launches of the frame together
    std::size_t items = 0;
};

// Device times of a finished frame by pass, in order of first launch. Needs a profiling queue.
std::vector<PassTime> pass_times(const std::vector<PassEvent>& events);

// The yardstick for kernels: independent fused multiply-adds in registers, as many as the device
// runs at once.
class PeakMeter {
public:
    explicit PeakMeter(const cl::CommandQueue& queue);
    double gflops();  // one measurement; a fused multiply-add counts as two

private:
    cl::CommandQueue queue_;
    cl::Kernel kernel_;
    cl::Buffer sink_;
    int width_;
    std::size_t items_;
};

}  // namespace clgi::lab
