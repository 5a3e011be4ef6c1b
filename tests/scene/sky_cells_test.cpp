// Directions that are drawn from an environment send, on average, the light of the environment.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/shared/halton.h>
#include <algorithm>
#include <numbers>
#include <vector>

#include "scene/environment.hpp"
#include "scene/luminance.hpp"
#include "scene/sky_cells.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t many_draws = 1u << 16;

Environment turned_sky(int width, int height) {
    Environment sky = test::rough_sky(width, height, 2.0);
    sky.rotation = 0.7f;
    return sky;
}

SkyWeights uneven_weights() {
    test::Random random(5);
    SkyWeights out{12, 6, {}};
    for (int k = 0; k < 72; ++k) out.values.push_back(static_cast<float>(random(0.05, 3.0)));
    return out;
}

struct Drawn {
    glm::dvec3 lux{0.0};
    glm::dvec3 vector[3] = {};  // lux towards the light, of each channel
};

Drawn mean_of_draws(const SkyCells& cells) {
    Drawn out;
    for (std::uint32_t k = 0; k < many_draws; ++k) {
        const SkyLight light = cells.drawn({radical_inverse(k, 2), radical_inverse(k, 3)});
        EXPECT_NEAR(glm::length(light.toward), 1.0, 1e-12);
        out.lux += light.lux / double{many_draws};
        for (int c = 0; c < 3; ++c)
            out.vector[c] += light.lux[c] / double{many_draws} * light.toward;
    }
    return out;
}

TEST(SkyCells, DrawTheLightOfTheEnvironment) {
    for (const Environment& sky :
         {test::even_sky({1, 2, 3}), turned_sky(40, 20), turned_sky(3, 1), turned_sky(600, 300)})
        for (const SkyWeights& weights : {SkyWeights(), uneven_weights()}) {
            const glm::dvec3 wanted = environment_fluence(sky);
            glm::dvec3 vector[3] = {};
            const Environment picture = with_picture(sky);
            for (int row = 0; row < picture.height; ++row)
                for (int column = 0; column < picture.width; ++column) {
                    const glm::dvec3 of = test::vector_of(
                        test::block_of(picture, row, 1, column, 1), double{sky.rotation});
                    const auto at = static_cast<std::size_t>(row * picture.width + column);
                    for (int c = 0; c < 3; ++c)
                        vector[c] += double{picture.texels[at][c]} * double{sky.factor[c]} * of;
                }
            const Drawn found = mean_of_draws(SkyCells(sky, weights));
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(found.lux[c], wanted[c], 0.01 * wanted[c]) << sky.width;
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_NEAR(found.vector[c][axis], vector[c][axis], 0.01 * wanted[c])
                        << sky.width << " " << c << axis;
            }
        }
}

// By luminance alone every draw is as bright as the sky.
TEST(SkyCells, DrawEquallyBrightLights) {
    const Environment sky = turned_sky(40, 20);
    const SkyCells cells(sky);
    const double wanted = luminance(environment_fluence(sky));
    for (std::uint32_t k = 0; k < 200; ++k) {
        const SkyLight light = cells.drawn({radical_inverse(k, 2), radical_inverse(k, 3)});
        EXPECT_NEAR(luminance(light.lux), wanted, 1e-9 * wanted);
    }
}

// Three quarters of the draws lie where the weight is three times as large, in the right half of
// the picture, and send two thirds as much each as draws without weights.
TEST(SkyCells, DrawMoreWhereWeightsAreLarger) {
    const SkyCells cells(test::even_sky(glm::vec3(1.0f)), {2, 1, {1.0f, 3.0f}});
    int right = 0;
    for (std::uint32_t k = 0; k < 1000; ++k) {
        // Not on an edge.
        const SkyLight light =
            cells.drawn({0.9999f * radical_inverse(k, 2) + 3e-5f, radical_inverse(k, 3)});
        const bool here = light.toward.x > 0.0;
        right += here;
        EXPECT_NEAR(light.lux.y, 4 * std::numbers::pi * (here ? 2.0 / 3.0 : 2.0), 1e-6);
    }
    EXPECT_NEAR(right, 750, 5);
}

// The same of rows: the upper half has three times the weight of the lower.
TEST(SkyCells, DrawMoreInRowsWhoseWeightsAreLarger) {
    const SkyCells cells(test::even_sky(glm::vec3(1.0f)), {1, 2, {3.0f, 1.0f}});
    int upper = 0;
    for (std::uint32_t k = 0; k < 1000; ++k)
        upper += cells.drawn({radical_inverse(k, 2), radical_inverse(k, 3)}).toward.y > 0.0;
    EXPECT_NEAR(upper, 750, 5);
}

// Under an even sky heights are even, within cells too.
TEST(SkyCells, DrawEvenlyWithinCells) {
    const SkyCells cells(test::even_sky(glm::vec3(1.0f)));
    constexpr std::size_t count = 4000;
    std::vector<double> heights;
    for (std::uint32_t k = 0; k < count; ++k)
        heights.push_back(cells.drawn({radical_inverse(k, 2), radical_inverse(k, 3)}).toward.y);
    std::sort(heights.begin(), heights.end());
    for (std::size_t k = 0; k < count; ++k)
        EXPECT_NEAR(heights[k], -1.0 + 2.0 * (k + 0.5) / count, 0.004) << k;
}

TEST(SkyCells, OfDarknessSendNothing) {
    const SkyLight light = SkyCells(test::even_sky(glm::vec3(0.0f))).drawn({0.3, 0.6});
    EXPECT_EQ(light.lux, glm::dvec3(0.0));
    EXPECT_NEAR(glm::length(light.toward), 1.0, 1e-12);
}

}  // namespace
}  // namespace clgi
