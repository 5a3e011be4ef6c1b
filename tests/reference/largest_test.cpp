// Which pixels a check finds the error in.
// SPDX-License-Identifier: MIT
#include "reference/largest.hpp"

#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>

#include "furnace.hpp"

namespace clgi {
namespace {

using reference::CheckedPixel;
using reference::Traced;

// A sample in each group: the truth is +- noise around light.
Traced traced(std::size_t pixel, std::size_t stratum, double weight, double picture, double light,
              double noise = 0.0) {
    Traced out;
    out.drawn = {pixel, stratum, weight};
    out.picture = picture;
    for (std::size_t g = 0; g < Traced::groups; ++g)
        out.add([&](std::size_t group, std::uint32_t) {
            return light + (group % 2 == 0 ? noise : -noise);
        });
    return out;
}

TEST(Largest, HaveTheirPartOfTheMeanOverStrata) {
    // Twice drawn, and one of three; over two strata of three and two draws.
    const std::vector<Traced> pixels = {traced(5, 0, 1.0, 4.0, 1.0), traced(5, 0, 1.0, 4.0, 1.0),
                                        traced(7, 0, 2.0, 2.0, 1.0), traced(12, 1, 0.5, 1.0, 3.0),
                                        traced(14, 1, 3.0, 1.0, 1.0)};
    const double of_5 = 2.0 * 9.0 / 3.0, of_7 = 2.0 / 3.0, of_12 = 0.5 * 4.0 / 2.0;
    const double all = of_5 + of_7 + of_12;
    const std::vector<CheckedPixel> found = reference::largest_of(pixels, 4, 8);
    ASSERT_EQ(found.size(), 3u) << "one pixel has no error";
    const double shares[] = {of_5 / all, of_12 / all, of_7 / all};
    const std::size_t columns[] = {1, 0, 3}, rows[] = {1, 3, 1};
    const double pictures[] = {4.0, 1.0, 2.0}, truths[] = {1.0, 3.0, 1.0};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(found[k].share, shares[k], 1e-12) << k;
        EXPECT_EQ(found[k].column, columns[k]) << k;
        EXPECT_EQ(found[k].row, rows[k]) << k;
        EXPECT_EQ(found[k].picture, pictures[k]) << k;
        EXPECT_NEAR(found[k].truth, truths[k], 1e-12) << k;
        EXPECT_NEAR(found[k].deviation, 0.0, 1e-12) << k;
    }
    EXPECT_EQ(reference::largest_of(pixels, 4, 2).size(), 2u);
}

TEST(Largest, SayHowFarTheTruthIsKnown) {
    // The mean of 16 samples of 1 and 3, whose variance by 8 of them is 8/7.
    const std::vector<Traced> twice = {traced(2, 0, 1.0, 9.0, 2.0, 1.0),
                                       traced(2, 0, 1.0, 9.0, 2.0, 1.0)};
    const std::vector<CheckedPixel> found = reference::largest_of(twice, 4, 8);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_NEAR(found[0].truth, 2.0, 1e-12);
    EXPECT_NEAR(found[0].deviation, std::sqrt(8.0 / 7.0 / 16.0), 1e-12);
    // Noise alone: the square that it leaves is below 0.
    EXPECT_TRUE(reference::largest_of({traced(2, 0, 1.0, 2.0, 2.0, 1.0)}, 4, 8).empty());
}

TEST(Largest, AreThePixelsOfAPictureThatAreWrong) {
    const Furnace box;
    std::vector<glm::vec3> picture(Furnace::width * Furnace::height, box.radiance);
    const auto at = [](std::size_t column, std::size_t row) {
        return row * Furnace::width + column;
    };
    picture[at(31, 5)] *= 9.0f;
    picture[at(3, 22)] *= 5.0f;
    reference::VerifyOptions check;
    check.pixels = 8000;
    check.samples = 16;
    const reference::Verification found = reference::PathTracer(box.scene).verify(
        box.camera, Furnace::width, Furnace::height, picture, check);
    ASSERT_EQ(found.largest.size(), 8u);
    const CheckedPixel &first = found.largest[0], &second = found.largest[1];
    EXPECT_EQ(first.column, 31u);
    EXPECT_EQ(first.row, 5u);
    EXPECT_EQ(second.column, 3u);
    EXPECT_EQ(second.row, 22u);
    // 8^2 and 4^2 times the light of a pixel.
    EXPECT_NEAR(first.share, 0.8, 0.1);
    EXPECT_NEAR(second.share, 0.2, 0.1);
    EXPECT_NEAR(first.picture, 9.0 * box.luminance, 1e-5 * box.luminance);
    EXPECT_GT(first.deviation, 0.0);
    EXPECT_NEAR(first.truth, box.luminance, 5.0 * first.deviation);
    EXPECT_LT(first.deviation, 0.1 * box.luminance);
}

}  // namespace
}  // namespace clgi
