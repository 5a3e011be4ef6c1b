// Times of pictures in whose first launches a driver compiles.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "core/kit/pass_timing.hpp"
#include "device.hpp"

namespace clgi {
namespace {

std::vector<PassEvent> fills(const cl::CommandQueue& queue) {
    const cl::Buffer buffer = test::empty<float>(1 << 16);
    std::vector<PassEvent> out;
    for (int k = 0; k < 2; ++k) {
        out.push_back({"fill", 1, {}});
        queue.enqueueFillBuffer(buffer, 1.0f, 0, sizeof(float) << 16, nullptr, &out.back().event);
    }
    queue.finish();
    return out;
}

// A picture that takes up to twice its passes' time and 150 ms keeps its time; one that takes more
// was compiled meanwhile, and took twice what its passes did.
TEST(PassTiming, LeavesCompilingOut) {
    const cl::CommandQueue& queue = test::device().queue;
    const std::vector<PassEvent> passes = fills(queue);
    double sum = 0.0;
    for (const PassEvent& pass : passes)
        sum +=
            1e-6 * static_cast<double>(pass.event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                       pass.event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    ASSERT_GT(sum, 0.0);
    const double most = 2.0 * sum + 150.0;
    EXPECT_EQ(timing::without_compiling(queue, most - 1e-3, passes), most - 1e-3);
    EXPECT_NEAR(timing::without_compiling(queue, most + 1e-3, passes), 2.0 * sum, 1e-9);
    EXPECT_EQ(timing::without_compiling(queue, 1000.0, {}), 1000.0);
}

TEST(PassTiming, KeepsTimesOfQueuesThatHaveNone) {
    const cl::CommandQueue plain(test::device().context, test::device().device);
    EXPECT_EQ(timing::without_compiling(plain, 1000.0, fills(plain)), 1000.0);
}

}  // namespace
}  // namespace clgi
