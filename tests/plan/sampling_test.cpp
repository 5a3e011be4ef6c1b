// How the time of a picture is divided between its settings and its samples.
// SPDX-License-Identifier: MIT
#include "program/sampling.hpp"

#include <gtest/gtest.h>

namespace clgi::program {
namespace {

TEST(Sampling, AddsToTheErrorOfSettings) {
    // Of four samples: with as many again 2^0.65 times less, with sixteen times as many 16^0.65.
    const Sampling four{0.8, 4.0, 0.25};
    EXPECT_DOUBLE_EQ(error_with_samples(0.0, four, 0.75), 0.8);
    EXPECT_DOUBLE_EQ(error_with_samples(0.6, four, 0.75), 1.0);
    EXPECT_NEAR(error_with_samples(0.0, four, 1.75), 0.8 / 1.5692, 1e-4);
    EXPECT_NEAR(error_with_samples(0.0, four, 15.75), 0.8 / 6.0629, 1e-4);
    const Sampling one{0.8, 1.0, 0.25};
    EXPECT_DOUBLE_EQ(error_with_samples(0.0, one, 0.0), 0.8);   // the first sample alone
    EXPECT_DOUBLE_EQ(error_with_samples(0.0, one, -3.0), 0.8);  // no time is left
}

// The last one comes first; two in a row count, as every second one may draw maps.
TEST(Sampling, TakesAsLongAsTheQuickestTwoInARow) {
    EXPECT_EQ(time_each({90.0, 0.0, 0.0, 0.0}, 1), 90.0);
    EXPECT_EQ(time_each({30.0, 90.0, 0.0, 0.0}, 2), 60.0);
    EXPECT_EQ(time_each({10.0, 30.0, 90.0, 0.0}, 3), 20.0);
    EXPECT_EQ(time_each({90.0, 40.0, 10.0, 20.0}, 4), 15.0);
    EXPECT_EQ(time_each({30.0, 10.0, 30.0, 10.0}, 9), 20.0);
}

// Finer settings leave less time: which is best depends on what a sample brings.
TEST(Sampling, DecidesBetweenCoarseAndFineSettings) {
    const auto fine_is_better = [](double error) {
        const Sampling one{error, 1.0, 0.1};
        return error_with_samples(0.05, one, 0.1) < error_with_samples(0.1, one, 6.3);
    };
    EXPECT_TRUE(fine_is_better(0.05));
    EXPECT_FALSE(fine_is_better(0.5));
}

// By those before it; the first of a picture has work that later ones share.
TEST(Sampling, ExpectsSamplesToTakeAsLongAsThoseBefore) {
    EXPECT_EQ(next_sample({20.0, 30.0, 25.0}, 5, 10.0), 30.0);
    EXPECT_EQ(next_sample({30.0, 20.0, 25.0}, 5, 0.0), 30.0);
    EXPECT_EQ(next_sample({20.0, 30.0, 45.0}, 5, 10.0), 45.0);
    EXPECT_EQ(next_sample({160.0, 0.0, 0.0}, 1, 0.0), 160.0);  // none is known
    EXPECT_EQ(next_sample({160.0, 0.0, 0.0}, 1, 20.0), 40.0);  // it has parts that others lack
    EXPECT_EQ(next_sample({160.0, 0.0, 0.0}, 1, 200.0), 160.0);
    EXPECT_EQ(next_sample({20.0, 160.0, 0.0}, 2, 20.0), 160.0);  // it may come again
}

}  // namespace
}  // namespace clgi::program
