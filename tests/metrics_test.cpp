// Error metrics against closed forms; the difference picture against its own colour space.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <array>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "report/difference.hpp"
#include "report/metrics.hpp"

namespace {

using clgi::io::Image;
using clgi::report::compare;

Image picture(int width, int height, float red, float green, float blue) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    Image image;
    image.width = width;
    image.height = height;
    image.channels = {{"R", std::vector<float>(pixels, red)},
                      {"G", std::vector<float>(pixels, green)},
                      {"B", std::vector<float>(pixels, blue)}};
    return image;
}

Image grey(int width, int height, float value) {
    return picture(width, height, value, value, value);
}

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

// sRGB bytes to OKLab, written from the definition: the way back from what the map does.
std::array<double, 3> oklab(const std::array<std::uint8_t, 3>& color) {
    std::array<double, 3> v{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double s = color[c] / 255.0;
        v[c] = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
    }
    const double l = std::cbrt(0.4122214708 * v[0] + 0.5363325363 * v[1] + 0.0514459929 * v[2]);
    const double m = std::cbrt(0.2119034982 * v[0] + 0.6806995451 * v[1] + 0.1073969566 * v[2]);
    const double s = std::cbrt(0.0883024619 * v[0] + 0.2817188376 * v[1] + 0.6299787005 * v[2]);
    return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
            1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
            0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::hypot(a[0] - b[0], std::hypot(a[1] - b[1], a[2] - b[2]));
}

TEST(DivergingColor, EqualStepsLookEqualOnBothSides) {
    constexpr int steps = 16;
    const double expected = std::hypot(0.97 - 0.45, 0.17) / steps;
    for (int i = 0; i < steps; ++i) {
        for (const double sign : {-1.0, 1.0}) {
            const auto here = oklab(clgi::report::diverging_color(sign * i / steps));
            const auto next = oklab(clgi::report::diverging_color(sign * (i + 1) / steps));
            // Half a byte of rounding is up to 0.003 in OKLab; clipping would be far more.
            EXPECT_NEAR(distance(here, next), expected, 0.008) << sign * i;
            EXPECT_LT(next[0], here[0]);
        }
    }
}

TEST(DivergingColor, ZeroIsNeutralAndTheEndsAreRedAndBlue) {
    const auto zero = oklab(clgi::report::diverging_color(0.0));
    EXPECT_NEAR(zero[0], 0.97, 0.005);
    EXPECT_NEAR(std::hypot(zero[1], zero[2]), 0.0, 0.005);
    const auto red = clgi::report::diverging_color(1.0), blue = clgi::report::diverging_color(-1.0);
    EXPECT_GT(red[0], red[2] + 80);
    EXPECT_GT(blue[2], blue[0] + 80);
    EXPECT_EQ(clgi::report::diverging_color(7.0), red);
}

TEST(DifferencePicture, IsRedWhereAIsBrighterAndBlueWhereBIs) {
    Image a = grey(3, 1, 1.0f);
    const Image b = a;
    for (auto& channel : a.channels) channel.values = {2.0f, 1.0f, 0.0f};
    const auto picture = clgi::report::difference_picture(a, b);
    ASSERT_EQ(picture.rgba.size(), 12u);
    EXPECT_EQ(picture.scale, 1.0);
    EXPECT_GT(picture.rgba[0], picture.rgba[2]);
    EXPECT_LT(picture.rgba[8], picture.rgba[10]);
    EXPECT_NEAR(picture.rgba[4], picture.rgba[6], 1);
    for (const std::size_t alpha : {3u, 7u, 11u}) EXPECT_EQ(picture.rgba[alpha], 255);
}

TEST(DifferencePicture, OfEqualPicturesIsBlank) {
    const auto picture = clgi::report::difference_picture(grey(4, 4, 1.0f), grey(4, 4, 1.0f));
    EXPECT_EQ(picture.scale, 0.0);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        EXPECT_NEAR(picture.rgba[i], 245, 6);
    }
}

TEST(DifferencePicture, OneBrightPixelDoesNotHideTheRest) {
    const Image b = grey(20, 20, 1.0f);
    Image a = grey(20, 20, 1.5f);
    a.channels[0].values[5] = 1e6f;
    EXPECT_DOUBLE_EQ(clgi::report::difference_picture(a, b).scale, 0.5);
}

TEST(DifferencePicture, TakesNonFiniteSamples) {
    Image a = grey(2, 2, 1.0f);
    a.channels[0].values[0] = std::numeric_limits<float>::quiet_NaN();
    a.channels[0].values[1] = std::numeric_limits<float>::infinity();
    const auto picture = clgi::report::difference_picture(a, grey(2, 2, 1.0f));
    EXPECT_TRUE(std::isfinite(picture.scale));
    EXPECT_EQ(picture.rgba.size(), 16u);
}

}  // namespace
