// What a device can do at most: the yardstick for kernels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/opencl.hpp>

namespace clgi::lab {

// Independent fused multiply-adds in registers, as many as the device runs at once.
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
