// When commands ran.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/export.hpp>
#include <clgi/opencl.hpp>

namespace clgi {

// Nanoseconds of the device's clock, as OpenCL's profiling has them.
struct Interval {
    cl_ulong queued = 0;     // the first command was given to its queue
    cl_ulong submitted = 0;  // the first was given to the device
    cl_ulong start = 0;      // the first began
    cl_ulong end = 0;        // the last ended

    double milliseconds() const { return 1e-6 * static_cast<double>(end - start); }
};

// The interval that covers all of these commands; zeros for none. An OpenCL event has the times of
// its own command alone, a marker's event those of the marker: no single event covers several
// commands. Throws Error when a command has not ended or its queue does not profile.
CLGI_API Interval interval(const WaitList& events);

}  // namespace clgi
