// The lights that stand for an environment: all of its light, cut in equal shares.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "scene/environment.hpp"
#include "scene/luminance.hpp"
#include "scene/median_cut.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

Environment sunny_sky() {
    return test::picture_sky(
        64, 32, [](int row, int column) { return row == 9 && column == 40 ? 1e5f : 1.0f; });
}

glm::dvec3 sum_of(const std::vector<SkyLight>& lights) {
    glm::dvec3 sum(0.0);
    for (const SkyLight& light : lights) sum += light.lux;
    return sum;
}

double lux_on(const std::vector<SkyLight>& lights, const glm::dvec3& normal) {
    double sum = 0.0;
    for (const SkyLight& light : lights)
        sum += light.lux.x * std::max(glm::dot(light.toward, normal), 0.0);
    return sum;
}

TEST(Fluence, IsTheIntegralOverAllDirections) {
    EXPECT_NEAR(environment_fluence(test::even_sky({1, 2, 3})).z, 12 * pi, 1e-12 * 12 * pi);
    // Texels are floats.
    EXPECT_NEAR(environment_fluence(test::gradient_sky()).x, 2 * pi, 1e-7 * 2 * pi);
    double wanted = 0.0;
    for (int row = 0; row < 32; ++row)
        wanted += 64 * test::solid_angle(test::block_of(sunny_sky(), row, 1, 0, 1));
    wanted += (1e5 - 1) * test::solid_angle(test::block_of(sunny_sky(), 9, 1, 40, 1));
    EXPECT_NEAR(environment_fluence(sunny_sky()).x, wanted, 1e-12 * wanted);
}

TEST(MedianCut, KeepsAllLight) {
    for (const Environment& sky :
         {test::even_sky({1, 2, 3}), test::gradient_sky(), sunny_sky(), test::rough_sky(40, 20),
          test::rough_sky(3, 1), test::rough_sky(600, 300)}) {
        const glm::dvec3 wanted = environment_fluence(sky);
        for (const int count : {1, 2, 7, 16, 64, 500}) {
            const auto lights = median_cut(sky, count);
            EXPECT_EQ(lights.size(), static_cast<std::size_t>(count));
            const glm::dvec3 sum = sum_of(lights);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], wanted[c], 1e-12 * wanted[c]) << count;
            for (const SkyLight& light : lights) EXPECT_NEAR(glm::length(light.toward), 1.0, 1e-12);
        }
    }
}

TEST(MedianCut, CutsInEqualShares) {
    // Whole cells are cut, so shares differ, the more the smaller they are. Measured: 0, 0.015 and
    // 0.04 under the even sky; 0.003, 0.017 and 0.038 under the rough one.
    for (const Environment& sky : {test::even_sky(glm::vec3(1.0f)), test::rough_sky(400, 200)}) {
        const double whole = luminance(environment_fluence(sky));
        for (const auto& [count, off] : {std::pair(4, 0.006), {16, 0.025}, {64, 0.055}})
            for (const SkyLight& light : median_cut(sky, count))
                EXPECT_NEAR(luminance(light.lux) * count / whole, 1.0, off) << count;
    }
}

TEST(MedianCut, PutsALightOnTheSun) {
    for (const float rotation : {0.0f, 2.0f}) {
        Environment sky = sunny_sky();
        sky.rotation = rotation;
        const test::SkyBlock sun = test::block_of(sky, 9, 1, 40, 1);
        const glm::dvec3 toward = glm::normalize(test::vector_of(sun, double{rotation}));
        const auto lights = median_cut(sky, 16);
        double near = 0.0;
        for (const SkyLight& light : lights)
            // Half a texel is 2.8 degrees.
            if (glm::dot(light.toward, toward) > std::cos(2.8 * pi / 180)) near += light.lux.x;
        EXPECT_GE(near, 1e5 * test::solid_angle(sun) * 0.999);
    }
}

TEST(MedianCut, OfNothingIsNothing) {
    EXPECT_TRUE(median_cut(test::even_sky(glm::vec3(0)), 16).empty());
    EXPECT_TRUE(median_cut(test::rough_sky(4, 2), 0).empty());
    // A single texel that shines, of cells that all have a share: no more lights than cells.
    const Environment one = test::picture_sky(
        256, 128, [](int row, int column) { return row == 3 && column == 4 ? 1.0f : 0.0f; });
    EXPECT_EQ(median_cut(one, 16).size(), 1u);
}

// What a plane receives that sees half of the sky, against pi/2 + pi/3 n.y: the root mean square of
// the relative error over 500 normals falls with the number of lights.
TEST(MedianCut, LightsPlanesBetterTheMoreLightsThereAre) {
    const Environment sky = test::gradient_sky();
    double before = 1.0;
    for (const auto& [count, most] : {std::pair(16, 0.06), {64, 0.015}, {256, 0.004}}) {
        const auto lights = median_cut(sky, count);
        double square = 0.0;
        for (int i = 0; i < 500; ++i) {
            const double y = 1 - (2 * i + 1) / 500.0, turn = i * 2.4;
            const glm::dvec3 normal(std::sqrt(1 - y * y) * std::cos(turn), y,
                                    std::sqrt(1 - y * y) * std::sin(turn));
            square += std::pow(lux_on(lights, normal) / (pi / 2 + pi / 3 * y) - 1, 2);
        }
        const double error = std::sqrt(square / 500);
        RecordProperty("error_of_" + std::to_string(count), std::to_string(error));
        EXPECT_LT(error, most) << count << " lights";
        EXPECT_LT(error, before) << count << " lights";
        before = error;
    }
}

}  // namespace
}  // namespace clgi
