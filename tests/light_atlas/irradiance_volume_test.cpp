// Irradiance volumes: the grid, its directions, and the buffers that a lookup needs.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>
#include <clgi/passes/atlas.hpp>
#include <cmath>
#include <limits>

#include "math_modes.hpp"
#include "refusals.hpp"

namespace clgi {
namespace {

TEST(IrradianceVolume, CoversItsBoxWithEqualCubes) {
    for (const glm::dvec3& size : {glm::dvec3(2.0, 1.0, 3.0), glm::dvec3(50.0, 0.01, 4.0),
                                   glm::dvec3(1e-6, 1e-6, 1e-6), glm::dvec3(7.0, 0.0, 0.0)})
        for (const int most : {1, 2, 27, 512}) {
            const Bounds box{glm::dvec3(-3.0, 10.0, 0.5), glm::dvec3(-3.0, 10.0, 0.5) + size};
            const IrradianceVolume v = make_irradiance_volume(box, most);
            const double points = double(v.count.x) * v.count.y * v.count.z;
            EXPECT_LE(points, most);
            if (most == 512) {
                EXPECT_GT(points * 2.5, most);
            }
            const glm::dvec3 low = v.first - 0.5 * v.spacing;
            const glm::dvec3 high = low + v.spacing * glm::dvec3(v.count);
            for (int k = 0; k < 3; ++k) {
                EXPECT_LE(low[k], box.low[k] + 1e-12);
                EXPECT_GE(high[k], box.high[k] - 1e-12);
                EXPECT_NEAR(low[k] + high[k], box.low[k] + box.high[k], 1e-9);
            }
        }
    const IrradianceVolume point = make_irradiance_volume({glm::dvec3(2.0), glm::dvec3(2.0)}, 512);
    EXPECT_EQ(point.count, glm::ivec3(1));
    EXPECT_EQ(point.first, glm::dvec3(2.0));
}

TEST(IrradianceVolume, RefusesBoxesThatAreNone) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_THROW(make_irradiance_volume({glm::dvec3(1.0), glm::dvec3(0.0)}, 8), Error);
    EXPECT_THROW(make_irradiance_volume({glm::dvec3(0.0), glm::dvec3(1.0, nan, 1.0)}, 8), Error);
    EXPECT_THROW(make_irradiance_volume({glm::dvec3(0.0), glm::dvec3(1.0, inf, 1.0)}, 8), Error);
    EXPECT_THROW(make_irradiance_volume({glm::dvec3(0.0), glm::dvec3(1.0)}, 0), Error);
    EXPECT_THROW(make_irradiance_volume({glm::dvec3(0.0), glm::dvec3(1.0)}, (1 << 20) + 1), Error);
}

TEST(IrradianceVolume, HasTheDirectionsOfAnIcosahedronAtEachPoint) {
    const IrradianceVolume volume =
        make_irradiance_volume({{0.75, 1.75, 2.75}, {2.25, 2.25, 3.75}}, 6);
    ASSERT_EQ(volume.count, glm::ivec3(3, 1, 2));
    const std::vector<BakePoint> points = points_of(volume);
    ASSERT_EQ(points.size(), 6u * VOLUME_DIRECTIONS);
    EXPECT_LT(glm::distance(points.back().position, glm::dvec3(2.0, 2.0, 3.5)), 1e-9);
    EXPECT_LT(glm::distance(points[VOLUME_DIRECTIONS].position, glm::dvec3(1.5, 2.0, 3.0)), 1e-9);
    for (std::size_t i = 0; i < points.size(); i += VOLUME_DIRECTIONS)
        for (std::size_t a = 0; a < VOLUME_DIRECTIONS; ++a) {
            EXPECT_NEAR(glm::length(points[i + a].normal), 1.0f, 1e-6f);
            int beside = 0, across = 0;
            for (std::size_t b = 0; b < VOLUME_DIRECTIONS; ++b) {
                const double c = glm::dot(points[i + a].normal, points[i + b].normal);
                beside += std::abs(c - 1.0 / std::sqrt(5.0)) < 1e-6;
                across += std::abs(c + 1.0) < 1e-6;
            }
            EXPECT_EQ(beside, 5);
            EXPECT_EQ(across, 1);
        }
}

TEST(IrradianceVolume, NeedsBuffersOfItsSize) {
    const VolumeParams params{float4(0, 0, 0, 1), 16, 16, 2, 3, 2, 1, 32, 112, 5, {}};
    const AtlasPasses passes(test::programs(), test::usual_build());
    const auto some = [](std::size_t bytes) {
        return cl::Buffer(test::device().context, CL_MEM_READ_WRITE, bytes);
    };
    const cl::Buffer planes = some(gbuffer_bytes(Storage::full, 16)), charts = some(2 * 8);
    const cl::Buffer ids = test::upload(std::vector<std::int32_t>(GBUFFER_ID_PLANES * 16, -1));
    const std::size_t places = 6 * 16, distances = 5 * 8 * VOLUME_TEXELS, light = 3 * 112 * 4;
    const cl::Buffer out = some(irradiance_bytes(Storage::full, 16));
    const auto call = [&](const VolumeParams& with, const cl::Buffer& a, const cl::Buffer& b,
                          const cl::Buffer& c) {
        passes.volume(test::device().queue, with, {planes, ids, 16, Storage::full}, charts, {a, b},
                      c, out);
    };
    test::expect_refusals(
        {{"atlas.volume", "places", places,
          [&](const cl::Buffer& b) { call(params, b, some(distances), some(light)); }},
         {"atlas.volume", "distances", distances,
          [&](const cl::Buffer& b) { call(params, some(places), b, some(light)); }},
         {"atlas.volume", "light", light,
          [&](const cl::Buffer& b) { call(params, some(places), some(distances), b); }}});
    VolumeParams more = params;
    more.open_count = 7;
    EXPECT_EQ(
        test::refusal<Error>([&] { call(more, some(places), some(2 * distances), some(light)); }),
        "atlas.volume: light_stride is 112, at least 116 needed");
}

}  // namespace
}  // namespace clgi
