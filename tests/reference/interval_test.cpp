// Which pixels a check draws, and what it makes of them: means, intervals, heavy tails.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "reference/interval.hpp"
#include "reference/pixel_draws.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using reference::Brightness;
using reference::Draw;
using reference::DrawnPixel;
using reference::ErrorAndEnergy;
using reference::PixelDraws;

double normal(test::Random& random) {
    return std::sqrt(-2.0 * std::log(random(1e-12, 1.0))) *
           std::cos(2.0 * 3.14159265358979 * random(0.0, 1.0));
}

// Draws of 50 strata, 6 of each, in which the mean of the truth is known to be 1.
template <typename Square>
std::vector<Draw> draws_of(Square&& square) {
    std::vector<Draw> out;
    for (std::size_t s = 0; s < 50; ++s)
        for (int k = 0; k < 6; ++k) out.push_back({s, square(s), 1.0, 1.0});
    return out;
}

TEST(Interval, KnowsStudentsTable) {
    for (const auto& [degrees, wanted] :
         std::initializer_list<std::array<double, 2>>{{1, 12.706},
                                                      {2, 4.303},
                                                      {3, 3.182},
                                                      {5, 2.571},
                                                      {8, 2.306},
                                                      {15, 2.131},
                                                      {60, 2.000}}) {
        EXPECT_GE(reference::student_t(degrees), wanted - 5e-4) << degrees;
        EXPECT_LE(reference::student_t(degrees), 1.04 * wanted) << degrees;
    }
    EXPECT_NEAR(reference::student_t(1e9), 1.960, 1e-3);
    EXPECT_NEAR(reference::student_t(0.3), 12.706, 1e-3) << "one at least";
}

TEST(Interval, HoldsEvenDrawsOfStrataThatDiffer) {
    // Only differences within strata count: every stratum has its own mean.
    int missed = 0;
    double width = 0.0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        test::Random random(seed);
        const ErrorAndEnergy found =
            reference::estimate(draws_of([&](std::size_t s) {
                                    return 0.001 * static_cast<double>(s) + 0.01 * normal(random);
                                }),
                                1.0);
        const double wanted = std::sqrt(0.0245);
        missed += wanted < found.error.low || wanted > found.error.high;
        width += (found.error.high - found.error.low) / 1000;
        EXPECT_DOUBLE_EQ(found.energy.value, 1.0);
    }
    EXPECT_LE(missed, 65);
    EXPECT_GE(missed, 5) << "wider than it says";
    // 2 x 1.96 x 0.01 / sqrt(300) over 2 sqrt(0.0245), and the guard.
    EXPECT_NEAR(width, 0.0072, 0.0012);
}

TEST(Interval, HoldsHeavyTails) {
    // Log-normal, the largest of 300 is a fifth of their sum.
    int above = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        test::Random random(seed);
        const ErrorAndEnergy found = reference::estimate(
            draws_of([&](std::size_t) { return 0.01 * std::exp(1.7 * normal(random)); }), 1.0);
        above += 0.1 * std::exp(1.7 * 1.7 / 4.0) > found.error.high;
    }
    EXPECT_LE(above, 75);
}

TEST(Interval, IsWideWhereOneDrawHasIt) {
    std::vector<Draw> draws = draws_of([](std::size_t) { return 0.0; });
    draws[123].square = 3.0;  // a mean of 0.01
    const ErrorAndEnergy found = reference::estimate(draws, 1.0);
    EXPECT_NEAR(found.error.value, 0.1, 1e-9);
    EXPECT_EQ(found.error.low, 0.0);
    // Of one event that was seen, up to 5.57 are expected (Poisson).
    EXPECT_GT(found.error.high, 0.1 * std::sqrt(5.57));
    EXPECT_LT(found.error.high, 0.3);
}

TEST(Interval, SaysWhatNoiseAloneAllows) {
    test::Random random(1);
    std::vector<Draw> draws = draws_of([&](std::size_t) { return 0.01 * normal(random) - 0.002; });
    const ErrorAndEnergy found = reference::estimate(draws, 1.0);
    EXPECT_EQ(found.error.value, 0.0);
    EXPECT_EQ(found.error.low, 0.0);
    // 1.96 x 0.01 / sqrt(300) and a little: above 0, not above the negative mean.
    EXPECT_NEAR(found.error.high, 0.035, 0.003);
}

TEST(Interval, TakesTheMeanOfThePictureFromAllPixels) {
    // The truth is 0.8 of the picture, which is uneven: its mean is known all the same.
    test::Random random(1);
    std::vector<Draw> draws = draws_of([](std::size_t) { return 0.04; });
    for (Draw& draw : draws) {
        draw.picture = random(0.0, 2.0);
        draw.light = 0.8 * draw.picture;
    }
    const ErrorAndEnergy found = reference::estimate(draws, 1.0);
    for (const double energy : {found.energy.low, found.energy.value, found.energy.high})
        EXPECT_NEAR(energy, 1.25, 1e-9);
    for (const double error : {found.error.low, found.error.value, found.error.high})
        EXPECT_NEAR(error, 0.25, 1e-6);
}

TEST(Interval, IsOfTheQuotientWhereTheTruthIsNoisy) {
    // Known mean square, noisy mean: the error is known as badly as the mean.
    test::Random random(1);
    std::vector<Draw> draws = draws_of([](std::size_t) { return 0.01; });
    for (Draw& draw : draws) draw.light = 1.0 + 1.7 * normal(random);  // +- 0.2
    const ErrorAndEnergy found = reference::estimate(draws, 1.0);
    EXPECT_NEAR(found.error.low * found.energy.value,
                0.1 * found.energy.low * found.error.value / 0.1, 0.03);
    EXPECT_LT(found.error.low, 0.9 * found.error.value);
    EXPECT_GT(found.error.high, 1.15 * found.error.value);
    EXPECT_LT(found.error.high, 1.5 * found.error.value);
}

// One sample of one pixel met light where the picture is black: no product of two samples says so.
TEST(Interval, HoldsTheDifferenceOfMeans) {
    std::vector<Draw> draws = draws_of([](std::size_t) { return 0.0; });
    for (Draw& draw : draws) draw = {draw.stratum, 0.0, 0.0, 0.0};
    draws[7].light = 300.0;
    const ErrorAndEnergy found = reference::estimate(draws, 0.0);
    EXPECT_EQ(found.energy.value, 0.0);
    EXPECT_GE(found.error.high, 1.0);
}

TEST(Interval, HasNoEndWhereTheTruthMayBeBlack) {
    std::vector<Draw> draws = draws_of([](std::size_t) { return 0.01; });
    for (Draw& draw : draws) draw.light = 0.0;
    ErrorAndEnergy found = reference::estimate(draws, 1.0);
    EXPECT_TRUE(std::isinf(found.error.value));
    EXPECT_TRUE(std::isinf(found.energy.high));
    draws[7].light = 300.0;
    found = reference::estimate(draws, 1.0);
    EXPECT_NEAR(found.energy.value, 1.0, 1e-9);
    EXPECT_TRUE(std::isinf(found.energy.high));
    EXPECT_TRUE(std::isinf(found.error.high));
    for (Draw& draw : draws) draw = {draw.stratum, 0.0, 0.0, 0.0};
    found = reference::estimate(draws, 0.0);
    EXPECT_EQ(found.error.value, 0.0) << "black, and so is what was found of the truth";
    EXPECT_TRUE(std::isinf(found.error.high));
    EXPECT_EQ(found.energy.value, 1.0);
    EXPECT_EQ(found.energy.low, 0.0);
}

Brightness uneven(std::size_t width, std::size_t height) {
    Brightness out{{}, width, height};
    test::Random random(3);
    for (std::size_t k = 0; k < width * height; ++k)
        out.values.push_back(static_cast<float>(k % 50 == 0 ? 30.0 : random(0.0, 2.0)));
    return out;
}

TEST(PixelDraws, WeightsMakeMeansOfThePicture) {
    const Brightness picture = uneven(37, 23);
    const PixelDraws draws(picture);
    double mean = 0.0, place = 0.0, found = 0.0, one = 0.0, found_place = 0.0;
    for (std::size_t k = 0; k < picture.values.size(); ++k) {
        mean += double{picture.values[k]} / (37.0 * 23.0);
        place += static_cast<double>(k) / (37.0 * 23.0);
    }
    EXPECT_NEAR(draws.mean(), mean, 1e-9);
    const std::vector<int> counts = {2, 40, 3, 7, 5};
    constexpr int times = 4000;
    for (std::uint64_t k = 0; k < times; ++k) {
        reference::Random random(k, 0, 0);
        for (const DrawnPixel& drawn : draws.draw(counts, random)) {
            ASSERT_LE(drawn.weight, 3.0 * 1.4);
            const double share = drawn.weight / (5.0 * counts[drawn.stratum] * times);
            found += share * double{picture.values[drawn.pixel]};
            found_place += share * static_cast<double>(drawn.pixel);
            one += share;
        }
    }
    EXPECT_NEAR(one, 1.0, 0.01);
    EXPECT_NEAR(found, mean, 0.02 * mean);
    EXPECT_NEAR(found_place, place, 0.01 * place);
}

TEST(PixelDraws, ComeByRisingStratumAndStayNearEachOther) {
    const Brightness picture{std::vector<float>(128 * 128, 1.0f), 128, 128};
    reference::Random random(1, 0, 0);
    const PixelDraws draws(picture);
    const auto drawn = draws.draw(std::vector<int>(128, 2), random);
    ASSERT_EQ(drawn.size(), 256u);
    for (std::size_t k = 0; k < drawn.size(); ++k) {
        EXPECT_EQ(drawn[k].stratum, k / 2);
        EXPECT_NEAR(drawn[k].weight, 1.0, 1e-9);
    }
    double apart = 0.0;
    for (std::size_t k = 0; k < drawn.size(); k += 2) {
        const auto distance = [](std::size_t a, std::size_t b) {
            return std::abs(static_cast<double>(a) - static_cast<double>(b));
        };
        apart = std::max({apart, distance(drawn[k].pixel % 128, drawn[k + 1].pixel % 128),
                          distance(drawn[k].pixel / 128, drawn[k + 1].pixel / 128)});
    }
    EXPECT_LE(apart, 24.0);  // strata are 128 pixels, about a block of 11 x 11
}

TEST(PixelDraws, FindABrightPixelInTheDark) {
    Brightness picture{std::vector<float>(100 * 80, 0.01f), 100, 80};
    picture.values[4711] = 1000.0f;
    const PixelDraws draws(picture);
    reference::Random random(1, 0, 0);
    std::size_t found = 0;
    for (const DrawnPixel& drawn : draws.draw(std::vector<int>(50, 4), random))
        found += drawn.pixel == 4711;
    EXPECT_GE(found, 50u);
}

TEST(PixelDraws, CoverABlackPictureAndOneOfASinglePixel) {
    for (const std::size_t pixels : {std::size_t{1}, std::size_t{77}}) {
        const Brightness picture{std::vector<float>(pixels, 0.0f), pixels, 1};
        reference::Random random(1, 0, 0);
        const PixelDraws draws(picture);
        const auto drawn = draws.draw({100, 100}, random);
        EXPECT_EQ(drawn.size(), 200u);
        for (const DrawnPixel& pixel : drawn) {
            EXPECT_LT(pixel.pixel, pixels);
            EXPECT_NEAR(pixel.weight, 1.0, 1e-12);
        }
    }
}

}  // namespace
}  // namespace clgi
