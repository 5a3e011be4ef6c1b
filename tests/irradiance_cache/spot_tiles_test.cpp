// Which tiles of a light's view light by VPLs, and where these lie.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "methods/irradiance_cache/spot_tiles.hpp"

namespace clgi {
namespace {

// Of a view of 2 x 2 m: nothing lit, a speck, a quarter of a tile, more than half of one.
TEST(SpotTiles, AreChosenWhereLittleIsLit) {
    std::vector<std::uint32_t> count(SPOT_TILES_A_VIEW, 0), chosen(SPOT_TILES_A_VIEW);
    std::vector<float> area(SPOT_TILES_A_VIEW, 0.0f);
    constexpr float tile = 2.0f / float{SPOT_TILES}, texel = tile * tile / 64.0f;
    const auto light = [&](std::size_t at, std::uint32_t texels) {
        count[at] = texels;
        area[at] = static_cast<float>(texels) * texel;
    };
    light(40, 1);
    light(41, 16);
    light(42, 33);
    light(200, 64);
    choose_tiles(count.data(), area.data(), 64, tile, chosen.data());
    for (std::size_t t = 0; t < SPOT_TILES_A_VIEW; ++t)
        EXPECT_EQ(chosen[t], t == 42 || t == 200 ? 0u : 1u) << t;
    // By squares of four tiles, in which none is lit by half; 42 and 200 are of others.
    choose_tiles(count.data(), area.data(), 64, 4.0f * tile, chosen.data());
    EXPECT_EQ(std::accumulate(chosen.begin(), chosen.end(), 0u), SPOT_TILES_A_VIEW);
    for (std::size_t row = 0; row < 4; ++row)
        for (std::size_t column = 0; column < 2; ++column) light(row * SPOT_TILES + column + 4, 64);
    light(4 * SPOT_TILES, 1);
    choose_tiles(count.data(), area.data(), 64, 4.0f * tile, chosen.data());
    for (std::size_t row = 0; row < 5; ++row)
        for (std::size_t column = 0; column < 12; ++column)
            EXPECT_EQ(chosen[row * SPOT_TILES + column],
                      row < 4 && column >= 4 && column < 8 ? 0u : 1u)
                << row << " " << column;
}

// Of two views, of which a texel of the second sends four times as much: 10 + 4 * 5 of
// 10 + 30 + 4 * (5 + 15) are in chosen tiles, a quarter.
TEST(SpotTiles, HaveVplsByTheRootOfTheirPower) {
    std::vector<std::uint32_t> count(SPOT_TILES_A_VIEW, 0), chosen(SPOT_TILES_A_VIEW, 0);
    LitPower lit;
    EXPECT_EQ(lit.vpls(128, 1), 128u);  // of nothing
    chosen[3] = chosen[9] = 1;
    count[3] = 10;
    lit.add(1.0, count.data(), chosen.data());
    EXPECT_EQ(lit.vpls(128, 1), 128u);
    count[3] = 0;
    count[7] = 30;
    lit.add(1.0, count.data(), chosen.data());
    count[7] = 15;
    count[9] = 5;
    lit.add(4.0, count.data(), chosen.data());
    EXPECT_EQ(lit.vpls(128, 1), 64u);
    EXPECT_EQ(lit.vpls(128, 40), 80u);  // two for each place
    EXPECT_EQ(lit.vpls(101, 1), 51u);   // rounded up
    EXPECT_EQ(lit.vpls(20, 1), 16u);    // some at least,
    EXPECT_EQ(lit.vpls(7, 1), 7u);      // as far as there are so many
    EXPECT_EQ(lit.vpls(0, 1), 0u);
    leave_chosen(count.data(), chosen.data());
    EXPECT_EQ(count[7], 0u);
    EXPECT_EQ(count[9], 5u);
    count[3] = 1;
    lit.add(std::numeric_limits<double>::quiet_NaN(), count.data(), chosen.data());
    EXPECT_EQ(lit.vpls(128, 1), 128u);
}

TEST(SpotTiles, AreLookedAtMoreClosely) {
    std::vector<std::uint32_t> count(SPOT_TILES_A_VIEW, 0), chosen(SPOT_TILES_A_VIEW, 1);
    View whole{};
    whole.right.w = 2.0f;
    whole.up.w = 1.0f;
    whole.window = {0.5f, -0.25f, 0.0f, 0.0f};
    EXPECT_TRUE(zoomed(whole, count.data(), chosen.data()).empty());
    count[0] = 1;                     // the corner: two by two tiles with those beside it
    count[10 * SPOT_TILES + 20] = 3;  // nine tiles
    count[12 * SPOT_TILES + 22] = 3;  // whose boxes overlap: five by five
    count[30 * SPOT_TILES + 5] = 1;
    chosen[30 * SPOT_TILES + 5] = 0;  // not a small place
    const std::vector<View> parts = zoomed(whole, count.data(), chosen.data());
    ASSERT_EQ(parts.size(), 2u);
    constexpr double across = SPOT_TILES;
    const auto expect = [&](const View& part, double left, double top, double right,
                            double bottom) {
        EXPECT_NEAR(part.window.x - part.right.w, 0.5 - 2.0 + 4.0 * left / across, 1e-6);
        EXPECT_NEAR(part.window.x + part.right.w, 0.5 - 2.0 + 4.0 * right / across, 1e-6);
        EXPECT_NEAR(part.window.y + part.up.w, -0.25 + 1.0 - 2.0 * top / across, 1e-6);
        EXPECT_NEAR(part.window.y - part.up.w, -0.25 + 1.0 - 2.0 * bottom / across, 1e-6);
    };
    expect(parts[0], 0, 0, 2, 2);
    expect(parts[1], 19, 9, 24, 14);
}

TEST(SpotTiles, HaveVplsByPower) {
    std::vector<std::uint32_t> count(2 * SPOT_TILES_A_VIEW, 0);
    count[3] = 100;
    count[SPOT_TILES_A_VIEW + 7] = 50;  // four times as strong each: twice as much in all
    const auto samples = spot_samples({1.0, 4.0}, count, 30);
    ASSERT_EQ(samples.size(), 30u);
    double texels[2] = {0.0, 0.0};
    std::uint32_t last[2] = {0, 0};
    for (const SpotSample& one : samples) {
        EXPECT_EQ(one.tile, one.view == 0 ? 3u : 7u);
        EXPECT_LT(one.rank, one.view == 0 ? 100u : 50u);
        EXPECT_GE(one.rank, last[one.view]);
        last[one.view] = one.rank;
        texels[one.view] += double{one.texels};
    }
    EXPECT_NEAR(texels[0], 100.0, 1e-3);
    EXPECT_NEAR(texels[1], 50.0, 1e-3);
    EXPECT_GT(last[0], 90u);
    EXPECT_EQ(spot_samples({0.0, 4.0}, count, 1000).size(), 50u);  // no more than texels
    EXPECT_TRUE(
        spot_samples({1.0, 1.0}, std::vector<std::uint32_t>(2 * SPOT_TILES_A_VIEW), 9).empty());
}

TEST(SpotTiles, FewerVplsSendAsMuch) {
    std::vector<Vpl> vpls(100);
    for (std::size_t i = 0; i < vpls.size(); ++i)
        vpls[i].flux = float4(i < 90 ? 1.0f : 9.0f, 0.5f, 0.25f, 1.0f);
    vpls[99].flux = float4(0.0f, 0.0f, 0.0f, 0.0f);
    const auto luminance = [](const Vpl& one) {
        return 0.2126 * one.flux.x + 0.7152 * one.flux.y + 0.0722 * one.flux.z;
    };
    double all = 0.0, left = 0.0;
    for (const Vpl& one : vpls) all += luminance(one);
    const std::vector<Vpl> thin = thinned(vpls, 25);
    ASSERT_EQ(thin.size(), 25u);
    for (const Vpl& one : thin) {
        left += luminance(one);
        EXPECT_NEAR(luminance(one), all / 25.0, 1e-5 * all);
        EXPECT_EQ(one.flux.w, 1.0f);
    }
    EXPECT_NEAR(left, all, 1e-5 * all);
    EXPECT_EQ(thinned(vpls, 100).size(), 100u);
    EXPECT_TRUE(thinned(std::vector<Vpl>(40), 25).empty());  // dark
    vpls[3].flux.y = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(thinned(vpls, 25).empty());
}

}  // namespace
}  // namespace clgi
