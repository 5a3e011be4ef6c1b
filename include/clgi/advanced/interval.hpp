// The time that commands took.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/opencl.hpp>

namespace clgi {

// Nanoseconds of the device's clock, from OpenCL's profiling.
struct Interval {
    cl_ulong queued = 0;     // the first command was enqueued
    cl_ulong submitted = 0;  // the first was submitted to the device
    cl_ulong start = 0;      // the first started
    cl_ulong end = 0;        // the last ended

    double milliseconds() const { return 1e-6 * static_cast<double>(end - start); }
};

// The interval that covers all of these commands; zeros if there are none. An OpenCL event has the
// times of its own command only, and a marker's event those of the marker, so no single event
// covers several. Throws Error when a command has not ended or its queue does not profile.
CLGI_API Interval interval(const WaitList& events);

}  // namespace clgi
