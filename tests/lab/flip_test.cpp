// FLIP against its definition in closed form, its properties, and what the authors' own program
// computes.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "lab/flip.hpp"
#include "lab/metrics.hpp"
#include "rgb_pictures.hpp"

namespace {

using clgi::lab::Display;
using clgi::lab::flip;
using clgi::lab::hdr_flip;
using rgb_pictures::drawn;
using rgb_pictures::grey;
using rgb_pictures::Image;
using rgb_pictures::picture;

Display display(const Image& image) {
    return {image.width,
            image.height,
            {image.find("R")->values, image.find("G")->values, image.find("B")->values}};
}

double mean(const std::vector<float>& map) {
    return std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

// Blocks of many colours; the second picture has fine texture on top. All samples are exact.
float pattern(int x, int y, int c, bool textured) {
    const int base = 2 * ((x / 5 * 7 + y / 4 * 13 + c * 5) % 32);
    const int extra = textured ? (x * x + 3 * y * (c + 1)) % 8 : 0;
    return static_cast<float>(std::min(base + extra, 64)) / 64.0f;
}

Image blocks(bool textured) {
    return drawn(48, 32, [&](int x, int y, int c) { return pattern(x, y, c, textured); });
}

// The same, its brightest pixel three stops above the median.
Image bright_blocks(bool textured) {
    return drawn(48, 32, [&](int x, int y, int c) {
        const float v = pattern(x, y, c, textured), square = v * v;
        return square * square * square * 64.0f + 1.0f / 64.0f;
    });
}

TEST(FlipFilters, SmoothingKeepsFlatPicturesAndFeaturesIgnoreThem) {
    const auto filters = clgi::lab::flip_filters();
    const auto sum = [](const clgi::lab::Kernel& kernel) {
        return std::accumulate(kernel.weights.begin(), kernel.weights.end(), 0.0);
    };
    for (const auto* kernel : {&filters.achromatic, &filters.red_green, &filters.blue_yellow[0],
                               &filters.blue_yellow[1], &filters.smooth}) {
        EXPECT_NEAR(sum(*kernel), 1.0, 1e-14);
    }
    EXPECT_NEAR(sum(filters.edge), 0.0, 1e-14);
    EXPECT_NEAR(sum(filters.point), 0.0, 1e-14);
    EXPECT_NEAR(filters.blue_yellow_share[0] + filters.blue_yellow_share[1], 1.0, 1e-14);
}

// 67 pixels a degree: 3 sqrt(0.04 / 2 pi^2) 67 = 9.05 and 3 (0.082 / 2) 67 = 8.24.
TEST(FlipFilters, ReachThreeStandardDeviations) {
    const auto filters = clgi::lab::flip_filters();
    EXPECT_EQ(filters.blue_yellow[0].radius, 10);
    EXPECT_EQ(filters.edge.radius, 9);
    EXPECT_EQ(filters.radius, 10);
}

TEST(Flip, OfEqualPicturesIsZero) {
    for (const float error : flip(display(blocks(true)), display(blocks(true)))) {
        EXPECT_EQ(error, 0.0f);
    }
}

// L* of white is 100, no colour: 100^0.7 over that of green against blue, beyond the knee at 0.4.
// Green is Lab (87.737, -86.185, 83.181), blue (32.303, 79.196, -107.863) [IEC 61966-2-1, CIE 15].
TEST(Flip, BlackAgainstWhiteHasItsClosedForm) {
    const double a = 0.87737 * -86.185 - 0.32303 * 79.196;
    const double b = 0.87737 * 83.181 - 0.32303 * -107.863;
    const double largest = std::pow(87.737 - 32.303 + std::hypot(a, b), 0.7);
    const double expected = 0.95 + (std::pow(100.0, 0.7) / largest - 0.4) / 0.6 * 0.05;
    for (const float error : flip(display(grey(9, 5, 0.0f)), display(grey(9, 5, 1.0f)))) {
        EXPECT_NEAR(error, expected, 2e-5);  // five digits of the Lab values
    }
}

TEST(Flip, GreenAgainstBlueIsTheLargestDifferenceOfAll) {
    const Display green = display(picture(3, 3, 0.0f, 1.0f, 0.0f));
    const Display blue = display(picture(3, 3, 0.0f, 0.0f, 1.0f));
    for (const float error : flip(green, blue)) EXPECT_NEAR(error, 1.0, 1e-6);
}

// Below the knee: L* of 0.18 is 49.496, of 0.2 is 51.837 [CIE 15].
TEST(Flip, AFaintDifferenceOfGreyFollowsThePowerLaw) {
    const double a = 0.87737 * -86.185 - 0.32303 * 79.196;
    const double b = 0.87737 * 83.181 - 0.32303 * -107.863;
    const double largest = std::pow(87.737 - 32.303 + std::hypot(a, b), 0.7);
    const double l = [](double y) { return 116.0 * std::cbrt(y); }(0.2) - 116.0 * std::cbrt(0.18);
    const double expected = std::pow(l, 0.7) / largest * 0.95 / 0.4;
    EXPECT_NEAR(flip(display(grey(1, 1, 0.2f)), display(grey(1, 1, 0.18f)))[0], expected, 1e-5);
}

TEST(Flip, DoesNotCareWhichPictureIsTheTruth) {
    const Display a = display(blocks(true)), b = display(blocks(false));
    EXPECT_EQ(flip(a, b), flip(b, a));
}

// Mirrored sums run in the other order; nothing else may change.
TEST(Flip, MirrorsWithThePictures) {
    const auto mirrored = [](bool textured) {
        return drawn(48, 32, [&](int x, int y, int c) { return pattern(47 - x, y, c, textured); });
    };
    const auto map = flip(display(blocks(true)), display(blocks(false)));
    const auto other = flip(display(mirrored(true)), display(mirrored(false)));
    for (std::size_t i = 0; i < map.size(); ++i) {
        EXPECT_NEAR(other[i / 48 * 48 + 47 - i % 48], map[i], 1e-6) << i;
    }
}

// Rows are worked on in bands of 64: no seam may show where one ends.
TEST(Flip, IsTheSameInEveryRowOfAPictureOfColumns) {
    const auto columns = [](float step) {
        return drawn(24, 150, [&](int x, int, int c) { return x % 7 == c ? 0.25f + step : 0.5f; });
    };
    const auto map = flip(display(columns(0.0f)), display(columns(0.5f)));
    for (std::size_t i = 24; i < map.size(); ++i) ASSERT_EQ(map[i], map[i % 24]) << i;
}

// An edge or a dot that comes or goes adds to the difference of colour.
TEST(Flip, ADotWeighsMoreThanItsColour) {
    Image dot = grey(41, 41, 0.5f);
    for (auto& channel : dot.channels) channel.values[20 * 41 + 20] = 1.0f;
    const auto map = flip(display(dot), display(grey(41, 41, 0.5f)));
    EXPECT_EQ(std::max_element(map.begin(), map.end()) - map.begin(), 20 * 41 + 20);
    EXPECT_EQ(map[0], 0.0f);
    EXPECT_LE(map[20 * 41 + 20], 1.0f);
}

// What flip-evaluator 1.7, the authors' own program, gives for these pictures; it works in float.
TEST(Flip, AgreesWithTheAuthorsProgram) {
    const auto map = flip(display(blocks(true)), display(blocks(false)));
    EXPECT_NEAR(mean(map), 0.1682707, 2e-6);
    EXPECT_NEAR(map[0], 0.23942028, 5e-6);
    EXPECT_NEAR(map[16 * 48 + 24], 0.1198988, 5e-6);
    EXPECT_NEAR(map.back(), 0.17982525, 5e-6);
}

TEST(HdrFlip, AgreesWithTheAuthorsProgram) {
    const auto map = hdr_flip(bright_blocks(true), bright_blocks(false));
    EXPECT_NEAR(mean(map), 0.3444124, 2e-6);
    EXPECT_NEAR(map[0], 0.13411021, 5e-6);
    EXPECT_NEAR(map[16 * 48 + 24], 0.3223241, 5e-6);
    EXPECT_NEAR(map.back(), 0.26713854, 5e-6);
}

// The brightest of 1 and 64 is six stops above the median; both ends are shown at 0.85.
TEST(HdrFlip, ExposuresRunFromTheBrightestToTheMedianPixel) {
    Image image = grey(3, 3, 1.0f);
    for (auto& channel : image.channels) channel.values[4] = 64.0f;
    const auto range = clgi::lab::exposures(image);
    EXPECT_EQ(range.count, 6);
    EXPECT_NEAR(range.last / range.first, 64.0, 1e-5);  // luminance weights of floats
    EXPECT_DOUBLE_EQ(range.at(0), range.first);
    EXPECT_NEAR(range.at(5), range.last, 1e-12);
    const double x = 0.6 * range.last;
    EXPECT_NEAR(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.85, 1e-9);
}

TEST(HdrFlip, BlackPixelsDoNotShiftTheExposures) {
    Image image = grey(4, 4, 0.0f);
    for (auto& channel : image.channels) channel.values[9] = 2.0f;
    const auto range = clgi::lab::exposures(image);
    EXPECT_EQ(range.count, 1);
    EXPECT_EQ(range.first, range.last);
    EXPECT_EQ(clgi::lab::exposures(grey(2, 2, 0.0f)).count, 0);
}

TEST(HdrFlip, BlackAgainstBlackIsZeroAndLightAgainstBlackIsNot) {
    EXPECT_EQ(mean(hdr_flip(grey(4, 4, 0.0f), grey(4, 4, 0.0f))), 0.0);
    EXPECT_GT(mean(hdr_flip(grey(4, 4, 3.0f), grey(4, 4, 0.0f))), 0.8);
}

TEST(HdrFlip, PowersOfTwoOnBothPicturesChangeNothing) {
    const auto scaled = [](bool textured, float factor) {
        Image image = bright_blocks(textured);
        for (auto& channel : image.channels) {
            for (float& v : channel.values) v *= factor;
        }
        return image;
    };
    const auto map = hdr_flip(bright_blocks(true), bright_blocks(false));
    for (const float factor : {0x1p-60f, 0x1p60f}) {
        EXPECT_EQ(hdr_flip(scaled(true, factor), scaled(false, factor)), map);
    }
}

TEST(HdrFlip, StaysBetweenZeroAndOneForAnySamples) {
    Image a = bright_blocks(true), b = bright_blocks(false);
    a.channels[0].values[7] = std::numeric_limits<float>::quiet_NaN();
    a.channels[1].values[99] = std::numeric_limits<float>::infinity();
    b.channels[2].values[5] = std::numeric_limits<float>::infinity();
    b.channels[2].values[6] = -5.0f;
    b.channels[1].values[50] = std::numeric_limits<float>::max();
    b.channels[0].values[60] = std::numeric_limits<float>::denorm_min();
    for (const float error : hdr_flip(a, b)) {
        ASSERT_GE(error, 0.0f);
        ASSERT_LE(error, 1.0f);
    }
}

TEST(HdrFlip, TheMeanIsThatOfThePixelsThatCount) {
    const Image a = bright_blocks(true), b = bright_blocks(false);
    const auto map = hdr_flip(a, b);
    const auto mask = clgi::lab::within(clgi::lab::whole_picture(48, 32), {47, 31, 1, 1});
    EXPECT_EQ(clgi::lab::compare(a, b, {&mask}).flip, map.back());
    EXPECT_FALSE(clgi::lab::compare(a, b, {&mask, false}).flip.has_value());
    EXPECT_DOUBLE_EQ(clgi::lab::compare(a, b).flip.value(), mean(map));
}

}  // namespace
