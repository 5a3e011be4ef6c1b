// What the library costs on top of OpenCL: passes against the same kernels enqueued by hand.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/opencl.hpp>
#include <functional>
#include <string>
#include <vector>

namespace clgi::lab {

struct LayerRow {
    std::string name;  // a pass, or "all in a row"
    double by_hand_ms = 0.0;
    double library_ms = 0.0;
    double ratio = 0.0;  // of the two ways: the median over rounds
};

// A 640x480 view and 64 VPLs. In every round each row is measured both ways, one straight after
// the other and in turns first, from the first call to the end on the device.
// progress: share done; false ends it with Error.
std::vector<LayerRow> bench_layer(const cl::CommandQueue& queue, int repeats,
                                  const std::function<bool(double)>& progress);

}  // namespace clgi::lab
