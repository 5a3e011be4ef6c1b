// How the time of a picture is divided between its settings and its samples.
// SPDX-License-Identifier: MIT
#include "program/sampling.hpp"

#include <gtest/gtest.h>

namespace clgi::program {
namespace {

TEST(Sampling, AddsToTheErrorOfSettings) {
    const Sampling one{0.8, 0.25};
    EXPECT_DOUBLE_EQ(error_with_samples(0.0, one, 0.0), 0.8);     // the first sample alone
    EXPECT_DOUBLE_EQ(error_with_samples(0.0, one, -3.0), 0.8);    // no time is left
    EXPECT_DOUBLE_EQ(error_with_samples(0.0, one, 3.75), 0.2);    // 15 more: a quarter
    EXPECT_DOUBLE_EQ(error_with_samples(0.15, one, 3.75), 0.25);  // 0.15^2 + 0.2^2 = 0.25^2
    EXPECT_DOUBLE_EQ(error_with_samples(0.6, one, 0.0), 1.0);
}

// Finer settings leave less time: which is best depends on what a sample brings.
TEST(Sampling, DecidesBetweenCoarseAndFineSettings) {
    const auto fine_is_better = [](double error) {
        const Sampling one{error, 0.1};
        return error_with_samples(0.05, one, 0.1) < error_with_samples(0.1, one, 6.3);
    };
    EXPECT_TRUE(fine_is_better(0.05));
    EXPECT_FALSE(fine_is_better(0.5));
}

}  // namespace
}  // namespace clgi::program
