// SPDX-License-Identifier: MIT
#include "core/kit/pass_timing.hpp"

namespace clgi::timing {

double without_compiling(const cl::CommandQueue& queue, double milliseconds,
                         std::span<const PassEvent> passes) {
    constexpr double usual = 2.0;    // times the passes' time
    constexpr double aside = 150.0;  // ms: one kernel takes as long
    if (passes.empty()) return milliseconds;
    if (!(queue.getInfo<CL_QUEUE_PROPERTIES>() & CL_QUEUE_PROFILING_ENABLE)) return milliseconds;
    // Elsewhere passes are quick, and most of the time is the host's.
    const auto device = queue.getInfo<CL_QUEUE_DEVICE>();
    if (!(device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU)) return milliseconds;
    double sum = 0.0;
    for (const PassEvent& pass : passes) {
        pass.event.wait();
        sum +=
            1e-6 * static_cast<double>(pass.event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                       pass.event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    }
    return milliseconds > usual * sum + aside ? usual * sum : milliseconds;
}

}  // namespace clgi::timing
