// Distances to generated bodies.
// SPDX-License-Identifier: MIT
#include "lab/scenes/flesh.hpp"

#include <gtest/gtest.h>
#include <cmath>

#include "scenes.hpp"

namespace clgi::generated {
namespace {

// Cones of two radii, one the other way round, and a ball.
Flesh body() {
    return {{{0, {-0.4, 0.1, 0.0}, {0.5, 0.3, 0.2}, 0.2, 0.05},
             {1, {0.1, -0.2, 0.3}, {0.0, 0.6, -0.1}, 0.04, 0.15},
             {2, {0.3, 0.2, 0.4}, {0.3, 0.2, 0.4}, 0.1, 0.3}},
            0.06};
}

// Of a cone along x: beside it the distance to the axis less the radius there, beyond its ends the
// distance to the end less the radius of the end.
TEST(Flesh, OfOneConeIsItsDistance) {
    const Flesh cone{{{0, {1, 0, 0}, {3, 0, 0}, 0.5, 0.25}}, 0.1};
    EXPECT_NEAR(cone.slope({1.5, 0.6, 0.8}).distance, 1.0 - 0.4375, 1e-12);
    EXPECT_NEAR(cone.slope({0.0, 0.0, 2.0}).distance, std::sqrt(5.0) - 0.5, 1e-12);
    EXPECT_NEAR(cone.slope({5.0, 0.0, 0.0}).distance, 2.0 - 0.25, 1e-12);
    EXPECT_NEAR(cone.slope({2.0, 0.1, 0.0}).distance, 0.1 - 0.375, 1e-12);
    const glm::dvec3 beside = cone.slope({1.5, 0.6, 0.8}).gradient;
    EXPECT_NEAR(beside.x, 0.125, 1e-12);  // the radius falls by an eighth a metre
    EXPECT_NEAR(beside.y, 0.6, 1e-12);
    EXPECT_NEAR(beside.z, 0.8, 1e-12);
}

// Two of the same place are -k log 2 nearer.
TEST(Flesh, FlowsTogether) {
    Flesh twice = body();
    const double once = twice.slope({0.9, 0.8, 0.7}).distance;
    const std::vector<Bone> bones = twice.bones;
    twice.bones.insert(twice.bones.end(), bones.begin(), bones.end());
    EXPECT_NEAR(twice.slope({0.9, 0.8, 0.7}).distance, once - 0.06 * std::log(2.0), 1e-12);
}

TEST(Flesh, SlopesAreDifferencesOfDistances) {
    const Flesh flesh = body();
    test::Random random(4);
    constexpr double step = 1e-5;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 p(random(-1, 1), random(-1, 1), random(-1, 1));
        const glm::dvec3 gradient = flesh.slope(p).gradient;
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 aside(0.0);
            aside[k] = step;
            const double difference =
                flesh.slope(p + aside).distance - flesh.slope(p - aside).distance;
            EXPECT_NEAR(gradient[k], difference / (2 * step), 2e-6) << i << " " << k;
        }
    }
}

}  // namespace
}  // namespace clgi::generated
