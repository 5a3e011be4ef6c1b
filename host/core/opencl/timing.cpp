// SPDX-License-Identifier: MIT
#include "core/opencl/timing.hpp"

#include <algorithm>

namespace clgi::timing {

Spread spread(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    const double median =
        values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
    return {values.front(), median, values.back()};
}

double time_frame(const cl::CommandQueue& queue, const std::function<void()>& enqueue) {
    const auto start = Clock::now();
    enqueue();
    queue.finish();
    return milliseconds(Clock::now() - start);
}

}  // namespace clgi::timing
