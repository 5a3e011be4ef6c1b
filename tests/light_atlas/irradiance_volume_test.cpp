// Irradiance volumes: the grid and its directions, and the lookup against polynomials that it has
// to bring back as they are.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>

#include "frames.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

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
}

TEST(IrradianceVolume, HasTheDirectionsOfAnIcosahedronAtEachPoint) {
    IrradianceVolume volume;
    volume.first = {1.0, 2.0, 3.0};
    volume.spacing = 0.5;
    volume.count = {3, 1, 2};
    const std::vector<BakePoint> points = points_of(volume);
    ASSERT_EQ(points.size(), 6u * VOLUME_DIRECTIONS);
    const auto& last = points.back();
    EXPECT_EQ(last.position, glm::dvec3(2.0, 2.0, 3.5));
    EXPECT_EQ(points[VOLUME_DIRECTIONS].position, glm::dvec3(1.5, 2.0, 3.0));
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

// A colour that is a polynomial of degree 2 of the direction and linear in space.
glm::dvec3 light_at(const glm::dvec3& at, const glm::dvec3& n) {
    const double along = 5.0 + 0.4 * at.x - 0.3 * at.y + 0.2 * at.z;
    return {along * (1.0 + 0.2 * n.x - 0.1 * n.y), along + n.x * n.y + 0.5 * n.z * n.z - 0.7 * n.z,
            3.0 + 2.0 * at.y * n.y * n.z + n.x};
}

// Surfaces that look a volume up: a triangle without a chart and one with one.
struct Looked {
    IrradianceVolume volume = {{-1.0, 0.5, 2.0}, 0.75, {4, 3, 2}};
    std::vector<glm::dvec3> places;
    std::vector<glm::vec3> normals;
    std::vector<std::int32_t> triangles;
    std::vector<float> light;  // [3][stride]
    std::uint32_t first = 32, stride = 0;

    Looked() {
        const std::vector<BakePoint> points = points_of(volume);
        stride = plane_stride(first + points.size());
        light.assign(3 * std::size_t{stride}, -77.0f);
        for (std::size_t i = 0; i < points.size(); ++i)
            set(i, light_at(points[i].position, points[i].normal));
    }
    void set(std::size_t point, const glm::dvec3& value) {
        for (int c = 0; c < 3; ++c)
            light[static_cast<std::size_t>(c) * stride + first + point] =
                static_cast<float>(value[c]);
    }
    void look(const glm::dvec3& at, const glm::vec3& normal, std::int32_t triangle = 0) {
        places.push_back(at);
        normals.push_back(normal);
        triangles.push_back(triangle);
    }

    // What is there before is -5.
    std::vector<glm::vec3> operator()() const {
        SceneFrame frame;
        frame.origin = {0.3, 0.2, -0.1};
        frame.scale = 0.125;
        const auto count = static_cast<std::uint32_t>(places.size());
        const std::uint32_t pixels = plane_stride(count);
        std::vector<float> planes(GBUFFER_PLANES * pixels);
        std::vector<std::int32_t> ids(GBUFFER_ID_PLANES * pixels, -1);
        for (std::uint32_t i = 0; i < count; ++i) {
            const glm::vec3 at = frame.to_local(places[i]);
            for (int c = 0; c < 3; ++c) {
                planes[(GBUFFER_POSITION + static_cast<unsigned>(c)) * pixels + i] = at[c];
                planes[(GBUFFER_NORMAL + static_cast<unsigned>(c)) * pixels + i] = normals[i][c];
            }
            ids[GBUFFER_TRIANGLE * pixels + i] = triangles[i];
        }
        const glm::vec3 origin = frame.to_local(volume.first);
        const VolumeParams params{
            float4(origin, static_cast<float>(1.0 / (volume.spacing * frame.scale))),
            count,
            pixels,
            2,
            static_cast<std::uint32_t>(volume.count.x),
            static_cast<std::uint32_t>(volume.count.y),
            static_cast<std::uint32_t>(volume.count.z),
            first,
            stride};
        const GBuffer seen{test::upload(planes), test::upload(ids), pixels, Storage::full};
        const cl::Buffer charts =
            test::upload(std::vector<std::uint32_t>{ATLAS_NONE, ATLAS_NONE, 0, 3});
        const cl::Buffer out = test::upload(std::vector<float>(3 * std::size_t{pixels}, -5.0f));
        AtlasPasses(test::programs(), test::usual_build())
            .volume(test::device().queue, params, seen, charts, test::upload(light), out);
        return test::vectors(test::device().queue, out, pixels, count);
    }
};

const glm::vec3 tilted = glm::normalize(glm::vec3(0.3f, -0.5f, 0.8f));

CLGI_IN_BOTH_MATHS(VolumeLookup);

TEST_P(VolumeLookup, BringsPolynomialsOfDegreeTwoBack) {
    Looked looked;
    for (int k = 0; k < 200; ++k) {
        const double u = std::fmod(0.618 * k, 1.0), v = std::fmod(0.414 * k, 1.0);
        const double z = 1.0 - 2.0 * (k + 0.5) / 200.0, s = std::sqrt(1.0 - z * z);
        looked.look({-1.0 + 2.25 * u, 0.5 + 1.5 * v, 2.0 + 0.75 * u * v},
                    {s * std::cos(2.4 * k), z, s * std::sin(2.4 * k)});
    }
    const auto found = looked();
    for (std::size_t i = 0; i < found.size(); ++i) {
        const glm::dvec3 wanted = glm::max(light_at(looked.places[i], looked.normals[i]), 0.0);
        // Each point counts as zero where it is below: only the last channel is.
        for (int c = 0; c < 2; ++c) EXPECT_NEAR(found[i][c], wanted[c], 1e-4) << i << " " << c;
        if (wanted.z > 1.0) {
            EXPECT_NEAR(found[i].z, wanted.z, 1e-4) << i;
        }
    }
}

TEST_P(VolumeLookup, TakesTheNearestPointsOutsideOfTheGrid) {
    Looked looked;
    looked.look({-9.0, 1.0, 2.1}, tilted);
    looked.look({1.0, 40.0, 2.1}, tilted);
    looked.look({1.0, 1.0, 1e6}, tilted);
    const auto found = looked();
    const glm::dvec3 nearest[3] = {{-1.0, 1.0, 2.1}, {1.0, 2.0, 2.1}, {1.0, 1.0, 2.75}};
    for (std::size_t i = 0; i < 3; ++i)
        for (int c = 0; c < 2; ++c)
            EXPECT_NEAR(found[i][c], light_at(nearest[i], tilted)[c], 2e-4) << i;
}

TEST_P(VolumeLookup, LeavesSurfacesOfTheAtlasAndTheBackground) {
    Looked looked;
    looked.look({0.0, 1.0, 2.2}, tilted, 1);
    looked.look({0.0, 1.0, 2.2}, tilted, -1);
    looked.look({0.0, 1.0, 2.2}, tilted, 2);  // of no scene
    looked.look({0.0, 1.0, 2.2}, tilted, 0);
    const auto found = looked();
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(found[static_cast<std::size_t>(i)], glm::vec3(-5.0f)) << i;
    EXPECT_GT(found[3].x, 0.0f);
}

// A point that little lights lies in a wall: its neighbours count alone. Where none is lit there is
// no light.
TEST_P(VolumeLookup, LeavesDarkPointsOut) {
    for (const double least : {0.0, 1e-8}) {
        Looked looked;
        const std::size_t columns = 4, rows = 3;
        for (std::size_t point = 0; point < 4 * 3 * 2; ++point) {
            const bool dark = point % columns >= 1;
            for (std::size_t i = 0; i < VOLUME_DIRECTIONS; ++i)
                looked.set(
                    point * VOLUME_DIRECTIONS + i,
                    dark ? glm::dvec3(least) : glm::dvec3(1.0, 2.0, 3.0) * (1.0 + double(point)));
        }
        looked.look({-0.4, 0.5, 2.0}, tilted);  // between the points 0 and 1 of the first row
        looked.look({-0.4, 1.25, 2.75}, tilted);
        looked.look({0.6, 1.0, 2.5}, tilted);  // between dark ones
        const auto found = looked();
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(found[0][c], 1.0f + float(c), 3e-5f * (1.0f + float(c)));
            EXPECT_NEAR(found[1][c], (1.0 + double(columns * (rows + 1))) * (1.0 + c), 1e-3);
            EXPECT_NEAR(found[2][c], least, 1e-13);
        }
    }
}

// Lit points a and b, b a fiftieth of a: in the middle b counts a / (a + b) * 2 / 50 / 0.05.
TEST_P(VolumeLookup, FadesPointsThatAreMuchDarker) {
    Looked looked;
    looked.volume = {{0.0, 0.0, 0.0}, 1.0, {2, 1, 1}};
    for (std::size_t point = 0; point < 2; ++point)
        for (std::size_t i = 0; i < VOLUME_DIRECTIONS; ++i)
            looked.set(point * VOLUME_DIRECTIONS + i,
                       glm::dvec3(1.0, 2.0, 4.0) * (point == 0 ? 1.0 : 0.02));
    looked.look({0.5, 0.0, 0.0}, tilted);
    const double counts = 0.02 / (0.05 * 0.51);
    const double wanted = (1.0 + counts * 0.02) / (1.0 + counts);
    const auto found = looked();
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[0][c], wanted * (1 << c), 1e-5 * (1 << c));
}

// One that lacks a colour is not dark.
TEST_P(VolumeLookup, CountsPointsThatLackAColour) {
    for (int missing = 0; missing < 3; ++missing) {
        Looked looked;
        looked.volume = {{0.0, 0.0, 0.0}, 1.0, {2, 1, 1}};
        for (std::size_t point = 0; point < 2; ++point)
            for (std::size_t i = 0; i < VOLUME_DIRECTIONS; ++i) {
                glm::dvec3 light(1.0, 2.0, 4.0);
                if (point == 1) light[missing] = 0.0;
                looked.set(point * VOLUME_DIRECTIONS + i, light);
            }
        looked.look({0.25, 0.0, 0.0}, tilted);
        const auto found = looked();
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[0][c], (c == missing ? 0.75 : 1.0) * (1 << c), 1e-5 * (1 << c));
    }
}

TEST_P(VolumeLookup, HasNoLightBelowZero) {
    Looked looked;
    // All light comes from one direction; seen from behind, the bands swing below zero.
    for (std::size_t point = 0; point < 24; ++point)
        for (std::size_t i = 0; i < VOLUME_DIRECTIONS; ++i)
            looked.set(point * VOLUME_DIRECTIONS + i, glm::dvec3(i == 0 ? 1.0 : 0.0));
    const glm::vec3 from = points_of(looked.volume)[0].normal;
    const glm::vec3 aside = glm::normalize(glm::cross(from, glm::vec3(1.0f, 0.2f, 0.1f)));
    looked.look({0.0, 1.0, 2.2}, glm::normalize(aside - 0.4f * from));
    looked.look({0.0, 1.0, 2.2}, from);
    const auto found = looked();
    EXPECT_EQ(found[0], glm::vec3(0.0f));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[1][c], 9.0 / 12.0, 1e-5);
}

TEST_P(VolumeLookup, SaysWhatIsNotFinite) {
    Looked looked;
    looked.look({std::numeric_limits<double>::quiet_NaN(), 1.0, 2.2}, tilted);
    looked.look({0.0, 1.0, 2.2}, tilted);
    looked.look({0.0, 1.0, 2.2}, {0.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f});
    const auto found = looked();
    for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(std::isnan(found[0][c]));
        EXPECT_TRUE(std::isfinite(found[1][c]));
        EXPECT_TRUE(std::isnan(found[2][c]));
    }
    // Light that is none reaches the surfaces around it.
    for (const float none :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        looked.set(0, glm::dvec3(none));
        looked.look({-0.9, 0.6, 2.1}, tilted);
        EXPECT_FALSE(std::isfinite(looked().back().x));
        EXPECT_TRUE(std::isfinite(looked()[1].x));
    }
}

}  // namespace
}  // namespace clgi
