// The colour maps against their own colour space.
// SPDX-License-Identifier: MIT
#include "lab/difference.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

namespace {

using clgi::lab::Color;
using clgi::lab::diverging_color;
using clgi::lab::sequential_color;

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
            const auto here = oklab(diverging_color(sign * i / steps));
            const auto next = oklab(diverging_color(sign * (i + 1) / steps));
            // Half a byte of rounding is up to 0.003 in OKLab; clipping would be far more.
            EXPECT_NEAR(distance(here, next), expected, 0.008) << sign * i;
            EXPECT_LT(next[0], here[0]);
        }
    }
}

TEST(DivergingColor, ZeroIsNeutralAndTheEndsAreRedAndBlue) {
    const auto zero = oklab(diverging_color(0.0));
    EXPECT_NEAR(zero[0], 0.97, 0.005);
    EXPECT_NEAR(std::hypot(zero[1], zero[2]), 0.0, 0.005);
    const auto red = diverging_color(1.0), blue = diverging_color(-1.0);
    EXPECT_GT(red[0], red[2] + 80);
    EXPECT_GT(blue[2], blue[0] + 80);
    EXPECT_EQ(diverging_color(7.0), red);
}

// A helix of chroma 0.095: up from lightness 0.22 to 0.93, round from 5.41 to 1.75 radians.
TEST(SequentialColor, EqualStepsLookEqual) {
    constexpr int steps = 16;
    const double chord = 2.0 * 0.095 * std::sin(0.5 * (5.41 - 1.75) / steps);
    const double expected = std::hypot((0.93 - 0.22) / steps, chord);
    for (int i = 0; i < steps; ++i) {
        const auto here = oklab(sequential_color(static_cast<double>(i) / steps));
        const auto next = oklab(sequential_color(static_cast<double>(i + 1) / steps));
        // Half a byte of rounding, which counts most in the dark; clipping would be far more.
        EXPECT_NEAR(distance(here, next), expected, 0.008) << i;
        EXPECT_GT(next[0], here[0]);
        EXPECT_NEAR(std::hypot(here[1], here[2]), 0.095, 0.006) << i;
    }
}

TEST(SequentialColor, RunsFromDarkVioletToLightYellow) {
    const Color least = sequential_color(0.0), most = sequential_color(1.0);
    EXPECT_NEAR(oklab(least)[0], 0.22, 0.005);
    EXPECT_NEAR(oklab(most)[0], 0.93, 0.005);
    EXPECT_GT(least[2], least[1] + 30);
    EXPECT_GT(most[1], most[2] + 40);
    EXPECT_EQ(sequential_color(-3.0), least);
    EXPECT_EQ(sequential_color(9.0), most);
}

TEST(ColorMaps, MarksAreOnNeitherMap) {
    for (const Color& mark : {clgi::lab::uncounted_color, clgi::lab::nonfinite_color}) {
        for (int i = 0; i <= 200; ++i) {
            const double value = i / 100.0 - 1.0;
            EXPECT_GT(distance(oklab(mark), oklab(diverging_color(value))), 0.05) << value;
            EXPECT_GT(distance(oklab(mark), oklab(sequential_color(value))), 0.05) << value;
        }
    }
}

}  // namespace
