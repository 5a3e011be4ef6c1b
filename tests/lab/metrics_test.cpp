// Error metrics against closed forms.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "lab/metrics.hpp"
#include "rgb_pictures.hpp"

namespace {

using clgi::lab::compare;
using rgb_pictures::grey;
using rgb_pictures::Image;
using rgb_pictures::picture;

TEST(Metrics, EqualPicturesHaveNoError) {
    const auto c = compare(picture(5, 3, 0.25f, 1.0f, 4.0f), picture(5, 3, 0.25f, 1.0f, 4.0f));
    EXPECT_EQ(c.rmse, 0.0);
    EXPECT_EQ(c.rel_rmse, 0.0);
    EXPECT_EQ(c.rel_mse, 0.0);
    EXPECT_EQ(c.smape, 0.0);
    EXPECT_EQ(c.max_abs, 0.0);
    EXPECT_EQ(c.energy_ratio, 1.0);
    EXPECT_EQ(c.mean_a, 1.75);
    EXPECT_EQ(c.psnr, std::numeric_limits<double>::infinity());
}

// a = 3, b = 2 everywhere: (a-b)^2 = 1 and floor (2/10)^2 = 0.04.
TEST(Metrics, ConstantOffsetHasItsClosedForm) {
    const auto c = compare(grey(4, 4, 3.0f), grey(4, 4, 2.0f));
    EXPECT_DOUBLE_EQ(c.rmse, 1.0);
    EXPECT_DOUBLE_EQ(c.rel_rmse, 0.5);
    EXPECT_DOUBLE_EQ(c.rel_mse, 1.0 / 4.04);
    EXPECT_DOUBLE_EQ(c.smape, 0.2);
    EXPECT_DOUBLE_EQ(c.psnr, 10.0 * std::log10(4.0));
    EXPECT_DOUBLE_EQ(c.energy_ratio, 1.5);
    EXPECT_EQ(c.max_abs, 1.0);
}

TEST(Metrics, EveryChannelCountsAThird) {
    const auto c = compare(picture(2, 2, 1.0f, 0.0f, 0.0f), grey(2, 2, 0.0f));
    EXPECT_DOUBLE_EQ(c.rmse, std::sqrt(1.0 / 3.0));
    EXPECT_DOUBLE_EQ(c.mean_a, 1.0 / 3.0);
    EXPECT_DOUBLE_EQ(c.smape, 1.0 / 3.0);
}

TEST(Metrics, ScalingBothPicturesLeavesRelativeErrorsAlone) {
    Image a = picture(3, 3, 1.0f, 2.0f, 3.0f), b = picture(3, 3, 1.5f, 1.75f, 3.5f);
    const auto before = compare(a, b);
    for (Image* image : {&a, &b}) {
        for (auto& channel : image->channels) {
            for (float& v : channel.values) v *= 0x1p-60f;
        }
    }
    const auto after = compare(a, b);
    EXPECT_DOUBLE_EQ(after.rmse, before.rmse * 0x1p-60);
    EXPECT_DOUBLE_EQ(after.rel_rmse, before.rel_rmse);
    EXPECT_DOUBLE_EQ(after.rel_mse, before.rel_mse);
    EXPECT_DOUBLE_EQ(after.smape, before.smape);
    EXPECT_DOUBLE_EQ(after.psnr, before.psnr);
}

TEST(Metrics, PsnrTakesItsPeakFromTheTruth) {
    Image truth = grey(10, 10, 0.0f);
    truth.channels[1].values[7] = 8.0f;
    Image off = truth;
    for (auto& channel : off.channels) {
        for (float& v : channel.values) v += 0.5f;
    }
    EXPECT_DOUBLE_EQ(compare(off, truth).psnr, 20.0 * std::log10(8.0 / 0.5));
}

TEST(Metrics, LargestDifferenceIsFoundWhereItIs) {
    const Image truth = grey(7, 5, 1.0f);
    Image a = truth;
    a.channels[2].values[3 * 7 + 4] = -1.0f;
    const auto c = compare(a, truth);
    EXPECT_EQ(c.max_abs, 2.0);
    EXPECT_EQ(c.max_x, 4);
    EXPECT_EQ(c.max_y, 3);
}

TEST(Metrics, BlackAgainstBlackIsNoError) {
    const auto c = compare(grey(2, 2, 0.0f), grey(2, 2, 0.0f));
    EXPECT_EQ(c.rel_rmse, 0.0);
    EXPECT_EQ(c.rel_mse, 0.0);
    EXPECT_EQ(c.smape, 0.0);
    EXPECT_EQ(c.energy_ratio, 1.0);
}

TEST(Metrics, LightAgainstBlackIsInfinitelyWrong) {
    const auto c = compare(grey(2, 2, 1.0f), grey(2, 2, 0.0f));
    EXPECT_TRUE(std::isinf(c.rel_rmse));
    EXPECT_TRUE(std::isinf(c.rel_mse));
    EXPECT_TRUE(std::isinf(c.energy_ratio));
    EXPECT_EQ(c.rmse, 1.0);
    EXPECT_EQ(c.smape, 1.0);
}

TEST(Metrics, NonFiniteSamplesAreCountedAndTheRestIsMeasured) {
    const Image truth = grey(4, 2, 1.0f);  // 24 samples
    Image a = truth;
    a.channels[0].values[0] = std::numeric_limits<float>::quiet_NaN();
    a.channels[1].values[5] = std::numeric_limits<float>::quiet_NaN();
    const auto c = compare(a, truth);
    EXPECT_DOUBLE_EQ(c.nonfinite_a, 2.0 / 24.0);
    EXPECT_EQ(c.nonfinite_b, 0.0);
    EXPECT_DOUBLE_EQ(c.rmse, std::sqrt(2.0 / 24.0));  // NaN counts as 0
    a.channels[2].values[0] = -std::numeric_limits<float>::infinity();
    EXPECT_TRUE(std::isfinite(compare(a, truth).rmse));
    EXPECT_DOUBLE_EQ(compare(truth, a).nonfinite_b, 3.0 / 24.0);
}

// Of 3000 samples three may lie above: the fourth largest is the answer.
TEST(Metrics, OneSampleInAThousandExceedsTheQuantile) {
    const Image truth = grey(50, 20, 1.0f);
    Image a = truth;
    for (int i = 0; i < 10; ++i) {
        a.channels[1].values[static_cast<std::size_t>(97 * i)] += static_cast<float>(i);
    }
    EXPECT_EQ(compare(a, truth).p999_abs, 6.0);
    EXPECT_EQ(compare(a, truth).max_abs, 9.0);
    EXPECT_EQ(compare(grey(1, 1, 3.0f), grey(1, 1, 1.0f)).p999_abs, 2.0);
}

TEST(Metrics, EveryPixelIsCounted) {
    const auto c = compare(grey(7, 5, 1.0f), grey(7, 5, 1.0f));
    EXPECT_EQ(c.pixels, 35u);
    EXPECT_EQ(c.flip, 0.0);
    EXPECT_EQ(c.p999_abs, 0.0);
    EXPECT_EQ(c.max_x, 0);
    EXPECT_EQ(c.max_y, 0);
}

TEST(Metrics, TheSamePicturesGiveTheSameBits) {
    const Image a = picture(31, 17, 0.1f, 0.7f, 3.3f), b = picture(31, 17, 0.2f, 0.6f, 3.0f);
    const auto first = compare(a, b), again = compare(a, b);
    EXPECT_EQ(first.rmse, again.rmse);
    EXPECT_EQ(first.rel_mse, again.rel_mse);
    EXPECT_EQ(first.smape, again.smape);
    EXPECT_EQ(first.flip, again.flip);
}

TEST(Metrics, LargestFloatsDoNotOverflow) {
    constexpr float largest = std::numeric_limits<float>::max();
    const auto c = compare(grey(8, 8, largest), grey(8, 8, -largest));
    EXPECT_DOUBLE_EQ(c.rmse, 2.0 * largest);
    EXPECT_DOUBLE_EQ(c.max_abs, 2.0 * largest);
}

// Naive summation in double loses every 1 beside 2^60; so would float sums far earlier.
TEST(Metrics, SmallSamplesAreNotLostBesideALargeOne) {
    Image a = grey(64, 64, 1.0f);
    a.channels[0].values[0] = 0x1p60f;
    a.channels[2].values.back() = -0x1p60f;
    const double samples = 3.0 * 64.0 * 64.0;
    EXPECT_DOUBLE_EQ(compare(a, a).mean_a, (samples - 2.0) / samples);
}

TEST(Metrics, OtherChannelsAndTheirOrderDoNotCount) {
    const Image truth = picture(2, 1, 1.0f, 2.0f, 3.0f);
    Image a = truth;
    std::swap(a.channels[0], a.channels[2]);
    a.channels.push_back({"A", {9.0f, 9.0f}});
    EXPECT_EQ(compare(a, truth).rmse, 0.0);
}

TEST(Metrics, DifferentSizesAreRefused) {
    EXPECT_THROW(compare(grey(2, 3, 1.0f), grey(3, 2, 1.0f)), clgi::InputError);
    EXPECT_THROW(compare(Image{}, Image{}), clgi::InputError);
}

TEST(Metrics, AMissingChannelIsRefused) {
    Image a = grey(2, 2, 1.0f);
    a.channels.pop_back();
    EXPECT_THROW(compare(a, grey(2, 2, 1.0f)), clgi::InputError);
    EXPECT_THROW(compare(grey(2, 2, 1.0f), a), clgi::InputError);
}

}  // namespace
