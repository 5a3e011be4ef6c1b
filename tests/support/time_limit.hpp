// A test that fails when it takes longer than anything hostile may.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <ctime>

namespace clgi::test {

// Processor time: a busy machine is no failure.
template <int Seconds>
class TimeLimit : public testing::Test {
protected:
    void TearDown() override {
#ifdef __SANITIZE_ADDRESS__
        constexpr double slowdown = 4.0;
#else
        constexpr double slowdown = 1.0;
#endif
        const double seconds = static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC;
        EXPECT_LT(seconds, Seconds * slowdown);
    }

private:
    std::clock_t start_ = std::clock();
};

}  // namespace clgi::test
