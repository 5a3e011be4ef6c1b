// Random numbers of the path tracer: independent, or even over the samples of a pixel.
// SPDX-License-Identifier: MIT
#include "reference/random.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <vector>

namespace clgi::reference {
namespace {

// The largest distance between shares of numbers below a limit and the limit.
double unevenness(std::vector<float> numbers) {
    std::sort(numbers.begin(), numbers.end());
    double out = 0.0;
    for (std::size_t i = 0; i < numbers.size(); ++i)
        out = std::max(
            out, std::abs((i + 0.5) / static_cast<double>(numbers.size()) - double{numbers[i]}));
    return out;
}

// Each pair of lists, as numbers that are independent of each other: the mean of their product
// about the middle has a deviation of 1 / (12 sqrt(n)).
void expect_independent(const std::vector<std::vector<float>>& lists) {
    const auto count = static_cast<double>(lists[0].size());
    for (std::size_t d = 0; d < lists.size(); ++d)
        for (std::size_t e = 0; e < d; ++e) {
            double product = 0.0;
            for (std::size_t k = 0; k < lists[0].size(); ++k)
                product += (lists[d][k] - 0.5) * (lists[e][k] - 0.5);
            EXPECT_LT(std::abs(product / count), 4.0 / (12.0 * std::sqrt(count))) << d << ' ' << e;
        }
}

// The first six numbers of a pixel's samples are even, alone and two and two; later ones random.
TEST(Random, IsEvenOverTheSamplesOfAPixel) {
    constexpr std::uint32_t samples = 512;
    constexpr std::size_t numbers = 8, even = 6;
    for (const std::uint64_t pixel : {0u, 5u, 77u}) {
        std::vector<std::vector<float>> found(numbers);
        for (std::uint32_t s = 0; s < samples; ++s) {
            Random random = Random::even(3, pixel, s);
            for (auto& one : found) one.push_back(random());
        }
        for (std::size_t d = 0; d < numbers; ++d) {
            for (const float x : found[d]) ASSERT_TRUE(x >= 0.0f && x < 1.0f);
            EXPECT_LT(unevenness(found[d]), d < even ? 0.015 : 0.09) << d;
            EXPECT_GT(unevenness(found[d]), d < even ? 0.0 : 0.015) << d;
        }
        expect_independent(found);
    }
}

// Whatever the sample, its numbers are anywhere over all pixels, independently of each other; and
// pixels and seeds have other numbers.
TEST(Random, IsAnywhereOverPixels) {
    constexpr std::uint64_t pixels = 4000;
    for (const std::uint32_t sample : {0u, 1u, 6u}) {
        std::vector<std::vector<float>> found(7);
        for (std::uint64_t pixel = 0; pixel < pixels; ++pixel) {
            Random random = Random::even(9, pixel, sample);
            for (auto& one : found) one.push_back(random());
        }
        for (const auto& one : found) EXPECT_LT(unevenness(one), 2.0 / std::sqrt(pixels));
        expect_independent(found);
    }
    EXPECT_NE(Random::even(1, 2, 3)(), Random::even(2, 2, 3)());
    EXPECT_NE(Random::even(1, 2, 3)(), Random::even(1, 3, 3)());
}

}  // namespace
}  // namespace clgi::reference
