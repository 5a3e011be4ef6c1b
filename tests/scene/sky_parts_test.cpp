// Skies in two parts: small bright ones, and the rest.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scene/environment.hpp"
#include "scene/luminance.hpp"
#include "scene/sky_parts.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

constexpr int width = 512, height = 256;

double level(const Environment& sky, std::size_t texel) {
    return luminance(glm::dvec3(sky.texels[texel]) * glm::dvec3(sky.factor));
}

// Directions within an angle of the axes have a colour of their own, the others another.
Environment with_discs(const std::vector<glm::dvec3>& axes, double angle, const glm::vec3& there,
                       const glm::vec3& elsewhere) {
    Environment out = test::picture_sky(width, height, [](int, int) { return 0.0f; });
    out.rotation = 0.4f;
    out.factor = {2.0f, 1.0f, 0.5f};
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            const glm::dvec3 d =
                environment_direction(out, (column + 0.5) / width, (row + 0.5) / height);
            bool in = false;
            for (const glm::dvec3& axis : axes)
                in = in || glm::dot(d, glm::normalize(axis)) > std::cos(angle);
            out.texels[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column)] =
                in ? there : elsewhere;
        }
    return out;
}

TEST(SkyParts, TellADiscFromTheRest) {
    constexpr double angle = 0.1;
    const glm::vec3 there(900, 500, 100), elsewhere(1, 2, 3);
    const Environment sky = with_discs({{0.3, 0.7, -0.5}}, angle, there, elsewhere);
    const double disc = 2.0 * pi * (1.0 - std::cos(angle)), whole = 4.0 * pi;
    const double high = luminance(glm::dvec3(there) * glm::dvec3(sky.factor)),
                 low = luminance(glm::dvec3(elsewhere) * glm::dvec3(sky.factor));
    const double all = disc * high + (whole - disc) * low, limit = 16.0 * all / whole;
    ASSERT_GT(high, 2.0 * limit);
    const SkyParts parts = sky_parts(sky);
    EXPECT_NEAR(parts.found.share, disc * (high - limit) / all, 0.01);
    EXPECT_NEAR(parts.found.solid_angle, disc, 0.02 * disc);
    EXPECT_EQ(parts.soft.rotation, sky.rotation);
    EXPECT_EQ(parts.bright.rotation, sky.rotation);
    std::size_t bright = 0;
    for (std::size_t i = 0; i < sky.texels.size(); ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(parts.soft.texels[i][c] + parts.bright.texels[i][c], sky.texels[i][c],
                        1e-6f * sky.texels[i][c]);
        if (sky.texels[i] == elsewhere) {
            EXPECT_EQ(parts.soft.texels[i], elsewhere);
            continue;
        }
        ++bright;
        EXPECT_NEAR(level(parts.soft, i), limit, 0.02 * limit);
        EXPECT_NEAR(parts.soft.texels[i].x / parts.soft.texels[i].z, 9.0f, 1e-4f);
    }
    EXPECT_GT(bright, 100u);
}

// Two lamps on both sides are no sun, however small each is.
TEST(SkyParts, KnowHowFarBrightOnesLieApart) {
    const glm::vec3 there(9000), elsewhere(1);
    const auto angle_of = [&](const glm::dvec3& second) {
        return sky_parts(with_discs({{1, 0, 0.2}, second}, 0.03, there, elsewhere))
            .found.solid_angle;
    };
    EXPECT_NEAR(angle_of({-1, 0, -0.2}), 4.0 * pi, 0.1);
    EXPECT_NEAR(angle_of({-0.2, 0, 1}), 4.0 * pi * (1.0 - std::sqrt(0.5)), 0.1);
    EXPECT_LT(angle_of({1, 0, 0.2}), 0.004);
}

TEST(SkyParts, LeaveEvenSkiesAlone) {
    const Environment dim = with_discs({{1, 1, 0}}, 0.02, glm::vec3(50), glm::vec3(1));  // 0.4 %
    for (const Environment& sky :
         {test::even_sky({1, 2, 3}), test::gradient_sky(), dim, test::rough_sky(32, 16, 0.6)}) {
        const SkyParts parts = sky_parts(sky);
        EXPECT_EQ(parts.found.share, 0.0);
        EXPECT_TRUE(parts.bright.texels.empty());
        EXPECT_EQ(parts.soft.texels, with_picture(sky).texels);
    }
}

}  // namespace
}  // namespace clgi
