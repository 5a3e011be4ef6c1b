// Which pixels count, and that metrics look at no others.
// SPDX-License-Identifier: MIT
#include "lab/mask.hpp"

#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <limits>

#include "lab/metrics.hpp"
#include "rgb_pictures.hpp"

namespace {

using clgi::lab::compare;
using clgi::lab::mask_of;
using clgi::lab::whole_picture;
using clgi::lab::within;
using rgb_pictures::drawn;
using rgb_pictures::grey;
using rgb_pictures::Image;

TEST(Mask, TheWholePictureCounts) {
    const auto mask = whole_picture(5, 3);
    EXPECT_EQ(mask.pixels, 15u);
    for (std::size_t i = 0; i < 15; ++i) EXPECT_TRUE(mask[i]);
}

TEST(Mask, APixelCountsWhereAnyChannelIsNotZero) {
    Image image = grey(4, 1, 0.0f);
    image.channels[2].values = {0.0f, 1e-30f, -0.5f, -0.0f};
    image.channels[0].values[0] = std::numeric_limits<float>::quiet_NaN();
    const auto mask = mask_of(image);
    EXPECT_EQ(mask.pixels, 3u);
    EXPECT_TRUE(mask[0] && mask[1] && mask[2]);
    EXPECT_FALSE(mask[3]);
}

TEST(Mask, WhatIsTransparentDoesNotCount) {
    Image image = grey(2, 1, 1.0f);
    image.channels.push_back({"A", {0.0f, 0.5f}});
    const auto mask = mask_of(image);
    EXPECT_FALSE(mask[0]);
    EXPECT_TRUE(mask[1]);
    // Opaque black does not count either.
    image = grey(2, 1, 0.0f);
    image.channels.push_back({"A", {1.0f, 1.0f}});
    EXPECT_EQ(mask_of(image).pixels, 0u);
}

TEST(Mask, OneChannelOfAnyNameIsEnough) {
    Image image;
    image.width = 2;
    image.height = 1;
    for (const char* name : {"Y", "A", "object.id"}) {
        image.channels = {{name, {0.0f, 7.0f}}};
        EXPECT_EQ(mask_of(image).pixels, 1u) << name;
    }
}

TEST(Mask, ARegionIsCutFromTheMask) {
    const auto stripes =
        mask_of(drawn(6, 4, [](int x, int, int) { return static_cast<float>(x % 2); }));
    const auto mask = within(stripes, {1, 2, 3, 2});
    EXPECT_EQ(mask.pixels, 4u);
    EXPECT_TRUE(mask[2 * 6 + 1]);
    EXPECT_FALSE(mask[2 * 6 + 2]);
    EXPECT_TRUE(mask[3 * 6 + 3]);
    EXPECT_FALSE(mask[3 * 6 + 5]);
    EXPECT_EQ(within(whole_picture(6, 4), {0, 0, 6, 4}).pixels, 24u);
}

TEST(Mask, RegionsThatLeaveThePictureAreRefused) {
    constexpr int most = std::numeric_limits<int>::max();
    for (const clgi::lab::Region& region : {clgi::lab::Region{-1, 0, 2, 2},
                                            {0, -1, 2, 2},
                                            {0, 0, 7, 1},
                                            {0, 0, 1, 5},
                                            {5, 0, 2, 1},
                                            {0, 0, 0, 1},
                                            {0, 0, 1, -1},
                                            {6, 4, 1, 1},
                                            {1, 1, most, most}}) {
        EXPECT_THROW(within(whole_picture(6, 4), region), clgi::InputError);
    }
}

TEST(Mask, MasksOfAnotherSizeAndEmptyOnesAreRefused) {
    const Image image = grey(3, 2, 1.0f);
    const auto turned = whole_picture(2, 3);
    EXPECT_THROW(compare(image, image, {&turned}), clgi::InputError);
    const auto none = mask_of(grey(3, 2, 0.0f));
    EXPECT_THROW(compare(image, image, {&none}), clgi::InputError);
    EXPECT_NO_THROW(compare(image, image));
}

// Whatever lies outside the mask, the metrics are those of the part cut out.
TEST(MaskedMetrics, AreThoseOfThePartAlone) {
    const auto a_at = [](int x, int y, int c) {
        return 0.5f + 0.25f * static_cast<float>(x + y * c);
    };
    const auto b_at = [](int x, int y, int c) {
        return 1.0f + 0.125f * static_cast<float>(x * c + y);
    };
    const auto part = [](const auto& at) {
        return drawn(3, 4, [&](int x, int y, int c) { return at(x + 2, y + 1, c); });
    };
    Image a = drawn(8, 6, a_at), b = drawn(8, 6, b_at);
    for (auto& channel : a.channels) {
        channel.values[0] = std::numeric_limits<float>::quiet_NaN();
        channel.values[47] = 1e30f;
    }
    b.channels[1].values[7] = std::numeric_limits<float>::infinity();
    const auto mask = within(whole_picture(8, 6), {2, 1, 3, 4});
    const auto masked = compare(a, b, {&mask, false});
    const auto alone = compare(part(a_at), part(b_at), {nullptr, false});
    EXPECT_EQ(masked.pixels, 12u);
    EXPECT_EQ(alone.pixels, 12u);
    EXPECT_EQ(masked.width, 8);
    EXPECT_EQ(masked.rmse, alone.rmse);
    EXPECT_EQ(masked.rel_rmse, alone.rel_rmse);
    EXPECT_EQ(masked.rel_mse, alone.rel_mse);
    EXPECT_EQ(masked.psnr, alone.psnr);
    EXPECT_EQ(masked.smape, alone.smape);
    EXPECT_EQ(masked.p999_abs, alone.p999_abs);
    EXPECT_EQ(masked.max_abs, alone.max_abs);
    EXPECT_EQ(masked.max_x, alone.max_x + 2);
    EXPECT_EQ(masked.max_y, alone.max_y + 1);
    EXPECT_EQ(masked.mean_a, alone.mean_a);
    EXPECT_EQ(masked.mean_b, alone.mean_b);
    EXPECT_EQ(masked.energy_ratio, alone.energy_ratio);
    EXPECT_EQ(masked.nonfinite_a, 0.0);
    EXPECT_EQ(masked.nonfinite_b, 0.0);
}

}  // namespace
