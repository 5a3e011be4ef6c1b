// The difference picture and the bar that says what its colours mean.
// SPDX-License-Identifier: MIT
#include "lab/difference.hpp"

#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "rgb_pictures.hpp"

namespace {

using clgi::lab::Color;
using clgi::lab::difference_picture;
using clgi::lab::Raster;
using clgi::lab::Shown;
using clgi::lab::with_scale_bar;
using rgb_pictures::drawn;
using rgb_pictures::grey;
using rgb_pictures::Image;
using rgb_pictures::picture;

Color color_at(const Raster& raster, int x, int y) {
    const auto pixel = 4 * static_cast<std::size_t>(y * raster.width + x);
    return {raster.rgba[pixel], raster.rgba[pixel + 1], raster.rgba[pixel + 2]};
}

TEST(DifferencePicture, IsRedWhereAIsBrighterAndBlueWhereBIs) {
    Image a = grey(3, 1, 1.0f);
    const Image b = a;
    for (auto& channel : a.channels) channel.values = {2.0f, 1.0f, 0.0f};
    const auto picture = difference_picture(a, b);
    ASSERT_EQ(picture.raster.rgba.size(), 12u);
    EXPECT_EQ(picture.scale.to, 1.0);
    EXPECT_GT(picture.raster.rgba[0], picture.raster.rgba[2]);
    EXPECT_LT(picture.raster.rgba[8], picture.raster.rgba[10]);
    EXPECT_NEAR(picture.raster.rgba[4], picture.raster.rgba[6], 1);
    for (const std::size_t alpha : {3u, 7u, 11u}) EXPECT_EQ(picture.raster.rgba[alpha], 255);
}

TEST(DifferencePicture, OfEqualPicturesIsBlank) {
    const auto picture = difference_picture(grey(4, 4, 1.0f), grey(4, 4, 1.0f));
    EXPECT_EQ(picture.scale.to, 0.0);
    for (std::size_t i = 0; i < picture.raster.rgba.size(); i += 4) {
        EXPECT_NEAR(picture.raster.rgba[i], 245, 6);
    }
}

TEST(DifferencePicture, OneBrightPixelDoesNotHideTheRest) {
    const Image b = grey(20, 20, 1.0f);
    Image a = grey(20, 20, 1.5f);
    a.channels[0].values[5] = 1e6f;
    EXPECT_DOUBLE_EQ(difference_picture(a, b).scale.to, 0.5);
}

TEST(DifferencePicture, TakesNonFiniteSamples) {
    Image a = grey(2, 2, 1.0f);
    a.channels[0].values[0] = std::numeric_limits<float>::quiet_NaN();
    a.channels[0].values[1] = std::numeric_limits<float>::infinity();
    const auto picture = difference_picture(a, grey(2, 2, 1.0f));
    EXPECT_TRUE(std::isfinite(picture.scale.to));
    EXPECT_EQ(picture.raster.rgba.size(), 16u);
}

TEST(DifferencePicture, ChoosesARoundScale) {
    EXPECT_DOUBLE_EQ(difference_picture(grey(9, 9, 1.137f), grey(9, 9, 1.0f)).scale.to, 0.15);
    EXPECT_DOUBLE_EQ(
        difference_picture(grey(9, 9, 1.0f), grey(9, 9, 0.0f), {.scale = 0.3}).scale.to, 0.3);
}

TEST(DifferencePicture, ShowsTheSizeOrFlipOnOneSidedScales) {
    const Image a = grey(4, 4, 1.0f), b = grey(4, 4, 3.0f);
    const auto size = difference_picture(a, b, {.shown = Shown::size});
    EXPECT_EQ(size.scale.from, 0.0);
    EXPECT_DOUBLE_EQ(size.scale.to, 2.0);
    EXPECT_EQ(color_at(size.raster, 1, 1), clgi::lab::sequential_color(1.0));
    const std::vector<float> map(16, 0.25f);
    const auto flip = difference_picture(a, b, {.shown = Shown::flip, .flip = &map});
    EXPECT_DOUBLE_EQ(flip.scale.to, 1.0);
    EXPECT_EQ(color_at(flip.raster, 1, 1), clgi::lab::sequential_color(0.25));
}

// Opposite differences of two channels cancel in the mean of a-b, not in that of |a-b|.
TEST(DifferencePicture, SizesDoNotCancel) {
    const Image a = picture(2, 2, 1.0f, 0.0f, 0.0f), b = picture(2, 2, 0.0f, 1.0f, 0.0f);
    EXPECT_EQ(difference_picture(a, b).scale.to, 0.0);
    EXPECT_NEAR(difference_picture(a, b, {.shown = Shown::size}).scale.to, 0.8, 1e-12);
}

TEST(DifferencePicture, MarksWhatDoesNotCountAndWhatIsNotFinite) {
    Image a = grey(3, 1, 2.0f);
    a.channels[1].values[0] = std::numeric_limits<float>::infinity();
    const auto mask = within(clgi::lab::whole_picture(3, 1), {0, 0, 2, 1});
    const auto picture = difference_picture(a, grey(3, 1, 1.0f), {.mask = &mask});
    EXPECT_EQ(picture.scale.to, 1.0);
    EXPECT_EQ(color_at(picture.raster, 0, 0), clgi::lab::nonfinite_color);
    EXPECT_EQ(color_at(picture.raster, 1, 0), clgi::lab::diverging_color(1.0));
    EXPECT_EQ(color_at(picture.raster, 2, 0), clgi::lab::uncounted_color);
}

TEST(DifferencePicture, DifferentSizesAreRefused) {
    EXPECT_THROW(difference_picture(grey(2, 3, 1.0f), grey(3, 2, 1.0f)), clgi::InputError);
}

TEST(RoundUp, GivesShortNumbers) {
    using clgi::lab::round_up;
    EXPECT_EQ(round_up(0.0), 0.0);
    EXPECT_DOUBLE_EQ(round_up(1.0), 1.0);
    EXPECT_DOUBLE_EQ(round_up(0.3), 0.3);
    EXPECT_DOUBLE_EQ(round_up(0.0301), 0.04);
    EXPECT_DOUBLE_EQ(round_up(8.1e20), 1e21);
    for (double value = 1e-30; value < 1e30; value *= 1.37) {
        EXPECT_GE(round_up(value), value * (1.0 - 1e-12));
        EXPECT_LE(round_up(value), 1.34 * value);
    }
}

// A picture without its bar is what is left where nothing can be drawn.
class ScaleBar : public testing::Test {
protected:
    Raster barred(const clgi::lab::DifferencePicture& picture) {
        Raster out = with_scale_bar(picture.raster, picture.scale);
        drawn_ = out.height > picture.raster.height;
        return out;
    }
    bool drawn_ = false;
};

TEST_F(ScaleBar, StandsBelowAPictureThatStaysAsItWas) {
    const Image a = drawn(300, 40, [](int x, int, int) { return static_cast<float>(x); });
    const auto plain = difference_picture(a, grey(300, 40, 150.0f));
    const Raster whole = barred(plain);
    EXPECT_EQ(whole.width, 300);
    for (std::size_t i = 0; i < plain.raster.rgba.size(); ++i) {
        ASSERT_EQ(whole.rgba[i], plain.raster.rgba[i]);
    }
    EXPECT_EQ(whole.rgba.size(), 4u * 300u * static_cast<std::size_t>(whole.height));
    if (!drawn_) GTEST_SKIP() << "no bar can be drawn";
    // Along a row of the bar the ends of the map are met, blue first, and below it are numbers.
    const auto is = [](const Color& one, const Color& two) {
        return std::abs(one[0] - two[0]) + std::abs(one[1] - two[1]) + std::abs(one[2] - two[2]) <
               8;
    };
    bool red_after_blue = false;
    int ink = 0;
    for (int y = 40; y < whole.height; ++y) {
        bool blue = false;
        for (int x = 0; x < whole.width; ++x) {
            const Color color = color_at(whole, x, y);
            blue = blue || is(color, clgi::lab::diverging_color(-1.0));
            red_after_blue = red_after_blue || (blue && is(color, clgi::lab::diverging_color(1.0)));
            ink += y > whole.height - 15 && color[0] < 128;
        }
    }
    EXPECT_TRUE(red_after_blue);
    EXPECT_GT(ink, 50);
}

TEST_F(ScaleBar, TakesTheSmallestPictureAndOneWithoutAnyDifference) {
    const Raster whole = barred(difference_picture(grey(1, 1, 1.0f), grey(1, 1, 1.0f)));
    if (!drawn_) GTEST_SKIP() << "no bar can be drawn";
    EXPECT_GE(whole.width, 200);
    EXPECT_EQ(color_at(whole, (whole.width - 1) / 2, 0), clgi::lab::diverging_color(0.0));
    EXPECT_EQ(color_at(whole, 0, 0), (Color{255, 255, 255}));
}

// The paper at the edges stays free, also of numbers that are long and far from round.
TEST_F(ScaleBar, LabelsFitBesideTheirBar) {
    for (const int width : {97, 1000})
        for (const double size : {1.2345e-7, 1.111e300}) {
            const Raster whole = barred(
                difference_picture(grey(width, 3, 1.0f), grey(width, 3, 0.0f), {.scale = size}));
            if (!drawn_) GTEST_SKIP() << "no bar can be drawn";
            for (int y = 4; y < whole.height; ++y)
                for (int x : {0, whole.width - 3, whole.width - 1})
                    ASSERT_EQ(color_at(whole, x, y), (Color{255, 255, 255}))
                        << width << " " << size;
            for (int x = 0; x < whole.width; ++x)
                ASSERT_EQ(color_at(whole, x, whole.height - 1), (Color{255, 255, 255}));
        }
}

}  // namespace
