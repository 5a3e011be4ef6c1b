// The difference picture and the bar that says what its colours mean.
// SPDX-License-Identifier: MIT
#include "lab/difference.hpp"

#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <cmath>
#include <limits>

#include "lab/lettering.hpp"
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

Color color_at(Raster raster, int x, int y) {
    const std::uint8_t* pixel = raster.at(x, y);
    return {pixel[0], pixel[1], pixel[2]};
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

TEST(ScaleBar, RoundsUpToShortNumbers) {
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

TEST(ScaleBar, LabelsAreShort) {
    using clgi::lab::tick_label;
    EXPECT_EQ(tick_label(0.0), "0");
    EXPECT_EQ(tick_label(-0.0), "0");
    EXPECT_EQ(tick_label(-0.375), "-0.375");
    EXPECT_EQ(tick_label(0.1 + 0.2), "0.3");
    EXPECT_EQ(tick_label(2e-7), "2e-7");
    EXPECT_EQ(tick_label(2.5e12), "2.5e12");
}

TEST(ScaleBar, StandsBelowAPictureThatStaysAsItWas) {
    const Image a = drawn(300, 40, [](int x, int, int) { return static_cast<float>(x); });
    const auto plain = difference_picture(a, grey(300, 40, 150.0f));
    const Raster whole = with_scale_bar(plain.raster, plain.scale);
    EXPECT_EQ(whole.width, 300);
    ASSERT_GT(whole.height, 40);
    for (std::size_t i = 0; i < plain.raster.rgba.size(); ++i) {
        ASSERT_EQ(whole.rgba[i], plain.raster.rgba[i]);
    }
    EXPECT_EQ(whole.rgba.size(), 4u * 300u * static_cast<std::size_t>(whole.height));
    // Along the middle of the bar the ends of the map are met, blue first.
    bool blue = false, red_after_blue = false;
    for (int x = 0; x < whole.width; ++x) {
        const Color color = color_at(whole, x, 40 + 9 + 5);
        blue = blue || color == clgi::lab::diverging_color(-1.0);
        red_after_blue = red_after_blue || (blue && color == clgi::lab::diverging_color(1.0));
    }
    EXPECT_TRUE(red_after_blue);
}

TEST(ScaleBar, TakesTheSmallestPictureAndOneWithoutAnyDifference) {
    const auto plain = difference_picture(grey(1, 1, 1.0f), grey(1, 1, 1.0f));
    const Raster whole = with_scale_bar(plain.raster, plain.scale);
    EXPECT_GE(whole.width, 200);
    EXPECT_EQ(color_at(whole, (whole.width - 1) / 2, 0), clgi::lab::diverging_color(0.0));
    EXPECT_EQ(color_at(whole, 0, 0), (Color{255, 255, 255}));
}

// The paper at the right edge stays free, also of numbers that are long and far from round.
TEST(ScaleBar, LabelsFitBesideTheirBar) {
    for (const int width : {1, 97, 300, 1000}) {
        for (const double size : {1.0, 1.2345e-7, 9876.5, 1.111e300}) {
            const auto plain =
                difference_picture(grey(width, 3, 1.0f), grey(width, 3, 0.0f), {.scale = size});
            const Raster whole = with_scale_bar(plain.raster, plain.scale);
            for (int y = 4; y < whole.height; ++y) {
                for (int x : {0, whole.width - 3, whole.width - 1}) {
                    ASSERT_EQ(color_at(whole, x, y), (Color{255, 255, 255}))
                        << width << " " << size;
                }
            }
        }
    }
}

TEST(Lettering, LeavesInkForEveryLetterThatItKnowsAndNoneElsewhere) {
    const auto ink = [](std::string_view text) {
        Raster raster(60, 40, {255, 255, 255});
        draw_text(raster, text, 20.0, 10.0, 18.0, {0, 0, 0});
        double sum = 0.0;
        for (std::size_t i = 0; i < raster.rgba.size(); i += 4) sum += 255 - raster.rgba[i];
        return sum / 255.0;
    };
    for (const char letter : std::string_view("0123456789+-eABFLIP|abcdefghjkmnopqrstuvwxyz%")) {
        EXPECT_GT(ink({&letter, 1}), 15.0) << letter;
    }
    for (const char* small : {".", ",", ":"}) EXPECT_GT(ink(small), 4.0) << small;
    for (const char* thin : {"i", "l"}) EXPECT_GT(ink(thin), 10.0) << thin;
    EXPECT_EQ(ink(" "), 0.0);
    EXPECT_EQ(ink("#"), 0.0);
    // 6 and 9 are one stroke, turned; a minus is its length times its thickness and round ends.
    EXPECT_NEAR(ink("6"), ink("9"), 0.5);
    EXPECT_NEAR(ink("b"), ink("q"), 1.5);
    EXPECT_NEAR(ink("-"), 3.0 * 3.0 * 2.0 * 0.42 * 3.0 + 3.1416 * 0.42 * 0.42 * 9.0, 1.0);
}

TEST(Lettering, LettersOutsideThePictureDoNoHarm) {
    Raster raster(3, 3, {255, 255, 255});
    draw_text(raster, "0123", -20.0, -20.0, 50.0, {0, 0, 0});
    EXPECT_EQ(raster.rgba.size(), 36u);
    EXPECT_EQ(clgi::lab::text_width("", 10.0), 0.0);
    EXPECT_DOUBLE_EQ(clgi::lab::text_width("00", 6.0), 4.0 + 1.5 + 4.0);
}

}  // namespace
