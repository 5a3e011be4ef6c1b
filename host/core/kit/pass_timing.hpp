// The time of a picture apart from that of kernels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <span>

namespace clgi::timing {

// Of `milliseconds` that passes took with all around them, those without the compiling of kernels,
// as some drivers do it on the first launch: then twice the passes' own time, as there is work of
// the host between them. As it is on devices that are no CPU, where the queue keeps no times, and
// without passes. Waits for the passes.
CLGI_API double without_compiling(const cl::CommandQueue& queue, double milliseconds,
                                  std::span<const PassEvent> passes);

}  // namespace clgi::timing
