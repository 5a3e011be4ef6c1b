// SPDX-License-Identifier: MIT
#include "lab/timing.hpp"

#include <algorithm>

namespace clgi::lab {

std::vector<PassTime> pass_times(const std::vector<PassEvent>& events) {
    std::vector<PassTime> out;
    for (const PassEvent& pass : events) {
        const double ns =
            static_cast<double>(pass.event.getProfilingInfo<CL_PROFILING_COMMAND_END>()) -
            static_cast<double>(pass.event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
        auto same = std::find_if(out.begin(), out.end(),
                                 [&](const PassTime& time) { return time.name == pass.name; });
        if (same == out.end()) same = out.insert(out.end(), {pass.name, 0.0, 0});
        same->milliseconds += 1e-6 * ns;
        same->items += pass.items;
    }
    return out;
}

}  // namespace clgi::lab
