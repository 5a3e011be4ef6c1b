// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/interval.hpp>
#include <clgi/error.hpp>

#include "core/opencl/error_text.hpp"

namespace clgi {

Interval interval(const WaitList& events) {
    Interval out;
    try {
        for (const cl::Event& event : events) {
            // Some drivers answer before that with what is not there yet.
            if (event.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() != CL_COMPLETE)
                throw cl::Error(CL_PROFILING_INFO_NOT_AVAILABLE, "interval");
            const Interval one{event.getProfilingInfo<CL_PROFILING_COMMAND_QUEUED>(),
                               event.getProfilingInfo<CL_PROFILING_COMMAND_SUBMIT>(),
                               event.getProfilingInfo<CL_PROFILING_COMMAND_START>(),
                               event.getProfilingInfo<CL_PROFILING_COMMAND_END>()};
            if (&event == &events.front()) out = one;
            out.queued = std::min(out.queued, one.queued);
            out.submitted = std::min(out.submitted, one.submitted);
            out.start = std::min(out.start, one.start);
            out.end = std::max(out.end, one.end);
        }
    } catch (const cl::Error& error) {
        throw Error("interval: " + error_text(error.err()) +
                    "; a queue made with CL_QUEUE_PROFILING_ENABLE and ended commands needed");
    }
    return out;
}

}  // namespace clgi
