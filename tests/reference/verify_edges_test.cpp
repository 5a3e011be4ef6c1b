// Checks of edges, where points in pixels decide.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>

#include "coverage.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// Edges of a panel alone, in a picture that has the exact area of what pixels show: points in
// pixels are even, so that the interval is narrower than that of independent ones (1.75).
TEST(Verify, KnowsEdgesWell) {
    constexpr int width = 43, height = 29;
    const std::vector<glm::dvec2> polygon = {{5.3, 4.1}, {37.7, 7.9}, {33.2, 24.6}, {11.9, 21.3}};
    const glm::vec3 glows(1.0f, 2.0f, 4.0f);
    std::vector<glm::vec3> picture;
    double mean = 0.0, variance = 0.0;
    for (const double share : test::coverage(polygon, width, height)) {
        picture.push_back(static_cast<float>(share) * glows);
        mean += share / (width * height);
        variance += share * (1.0 - share) / (width * height);
    }
    reference::VerifyOptions options;
    options.filter = reference::Filter::box;
    options.samples = 256;
    const reference::Verification found =
        reference::PathTracer(test::glowing_quad(polygon, glows))
            .verify(test::pixel_camera(width, height), width, height, picture, options);
    EXPECT_EQ(found.error.low, 0.0);
    EXPECT_NEAR(found.energy.value, 1.0, 0.003);
    const double independent = std::sqrt(variance / options.samples) / mean;
    EXPECT_LT(found.error.high, 1.4 * independent);
}

}  // namespace
}  // namespace clgi
