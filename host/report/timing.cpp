// SPDX-License-Identifier: MIT
#include "report/timing.hpp"

#include <algorithm>
#include <chrono>

namespace clgi::report {

Spread spread(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median =
        values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
    return {values.front(), median, values.back()};
}

double time_frame(SecondOrderSolver& solver, const cl::CommandQueue& queue, const Camera& camera) {
    return time_frame(queue, [&] { solver.render(camera); });
}

double time_frame(const cl::CommandQueue& queue, const std::function<void()>& enqueue) {
    const auto start = std::chrono::steady_clock::now();
    enqueue();
    queue.finish();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
        .count();
}

std::vector<PassTime> pass_times(const SecondOrderSolver& solver) {
    return pass_times(solver.events());
}

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

}  // namespace clgi::report
