// Bins of directions: opposite pairs, solid angles, nearest bins, hemispheres.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/direction_bins.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace clgi {
namespace {

using std::numbers::pi;

glm::dvec3 any_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
}

class Bins : public testing::TestWithParam<int> {
protected:
    const DirectionBins bins = direction_bins(GetParam());
};

TEST_P(Bins, ComeInOppositePairs) {
    ASSERT_EQ(bins.count(), GetParam());
    for (int i = 0; i < bins.count(); ++i) {
        const int back = bins.opposite(i);
        EXPECT_EQ(bins.opposite(back), i);
        EXPECT_EQ(bins.directions[i], -bins.directions[back]);
        EXPECT_EQ(bins.solid_angles[i], bins.solid_angles[back]);
        EXPECT_NEAR(glm::length(bins.directions[i]), 1.0, 1e-15);
    }
}

// The solid angles are those of the cells that nearest() divides the sphere into: all of it, and
// each as many directions as chance gives it.
TEST_P(Bins, SolidAnglesAreThoseOfTheDirectionsNearestToThem) {
    double all = 0.0;
    for (const double angle : bins.solid_angles) all += angle;
    EXPECT_NEAR(all, 4.0 * pi, 1e-11);

    constexpr int draws = 200000;
    std::mt19937 random(7);
    std::vector<int> hits(bins.directions.size());
    for (int i = 0; i < draws; ++i) ++hits[bins.nearest(any_direction(random))];
    double chi = 0.0;
    for (int i = 0; i < bins.count(); ++i) {
        const double expected = draws * bins.solid_angles[i] / (4.0 * pi);
        chi += (hits[i] - expected) * (hits[i] - expected) / expected;
    }
    const double freedom = bins.count() - 1;
    EXPECT_LT(chi, freedom + 4.0 * std::sqrt(2.0 * freedom));
}

TEST_P(Bins, AreSpreadEvenly) {
    const double mean = 4.0 * pi / bins.count();
    const auto [least, most] =
        std::minmax_element(bins.solid_angles.begin(), bins.solid_angles.end());
    EXPECT_GT(*least, 0.85 * mean);
    EXPECT_LT(*most, 1.15 * mean);
    double nearest = pi;
    for (int i = 0; i < bins.count(); ++i)
        for (int k = 0; k < i; ++k)
            nearest = std::min(
                nearest,
                std::acos(std::clamp(glm::dot(bins.directions[i], bins.directions[k]), -1., 1.)));
    EXPECT_GT(nearest, 0.85 * std::sqrt(mean));  // a hexagonal grid has 1.07
}

TEST_P(Bins, NearestIsTheNearest) {
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 direction = any_direction(random);
        int best = 0;
        for (int k = 1; k < bins.count(); ++k)
            if (glm::dot(bins.directions[k], direction) >
                glm::dot(bins.directions[best], direction))
                best = k;
        EXPECT_EQ(bins.nearest(direction), best);
        EXPECT_EQ(bins.nearest(1e-3 * direction), best);
    }
    for (int k = 0; k < bins.count(); ++k) EXPECT_EQ(bins.nearest(bins.directions[k]), k);
}

TEST_P(Bins, HemispheresReflectWhatArrives) {
    std::mt19937 random(5);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 normal = any_direction(random);
        const double scale = bins.hemisphere_scale(normal);
        double above = 0.0, below = 0.0;
        for (int k = 0; k < bins.count(); ++k) {
            const double cosine = scale * glm::dot(normal, bins.directions[k]);
            (cosine > 0.0 ? above : below) += bins.solid_angles[k] * std::abs(cosine);
        }
        EXPECT_NEAR(above, pi, 1e-12);
        EXPECT_NEAR(below, pi, 1e-12);
        EXPECT_NEAR(scale, 1.0, 2.5 / bins.count());
    }
}

INSTANTIATE_TEST_SUITE_P(Counts, Bins, testing::Values(32, 128, 208, 512, 1024),
                         testing::PrintToStringParamName());

TEST(DirectionBins, OtherCountsAreRefused) {
    for (const int count : {0, -2, 30, 129, 4098, std::numeric_limits<int>::max()})
        EXPECT_THROW(direction_bins(count), Error) << count;
}

}  // namespace
}  // namespace clgi
