// The lookup of a light atlas at points of surfaces: bilinear inside charts, nothing over their
// borders.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "math_modes.hpp"
#include "shown_atlas.hpp"

namespace clgi {
namespace {

using test::place_of;
using test::random_points;
using test::tilted_quad;
using Point = test::AtlasPoint;
using Shown = test::ShownAtlas;

constexpr std::uint32_t none = test::no_triangle;

double slanted_light(const glm::dvec3& p) { return 4.0 + 0.7 * p.x - 1.3 * p.y + 0.4 * p.z; }

TEST(AtlasShow, IsExactForALinearFunctionInsideAChart) {
    const Shown shown(tilted_quad(), 48);
    const std::vector<Point> points = random_points(shown.world, 1000);
    const auto found = shown(points, shown.light(slanted_light));
    int inside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto taps = shown.taps(points[i]);
        // At the edge of the page a texel counts twice, in the place of one beyond.
        bool centres =
            taps.size() == 4 && taps[0].first != taps[1].first && taps[0].first != taps[2].first;
        for (const auto& [texel, weight] : taps) centres &= shown.layout.texels[texel].centre;
        if (!centres) continue;
        ++inside;
        const double wanted = slanted_light(place_of(shown.world, points[i]));
        // Places are known to 2^-23 of the scene's radius of 1.1 m, of which a texel is a 40th.
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(found[i][c], wanted * (c == 2 ? -3.0 : c + 1.0), 2e-5) << i;
    }
    EXPECT_GT(inside, 800);
}

// At the edges of charts too, where fewer than four texels count.
TEST(AtlasShow, IsWhatTheFormulaSaysAtEveryPoint) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-0.5, 0.1, -0.3}, {0.9, 0.8, 0.4}, 1);
    int fewer = 0;  // points with fewer than four texels, on one page and on several
    for (const int pages : {1, 3}) {
        const Shown shown(scene, 40, AtlasUvs::charts, pages);
        ASSERT_GE(shown.layout.charts.size(), 6u);
        ASSERT_EQ(shown.layout.pages > 1, pages > 1);
        const std::vector<Point> points = random_points(scene, 2003);
        std::vector<float> light;
        test::Random random(8);
        for (std::size_t i = 0; i < shown.layout.texels.size(); ++i)
            light.push_back(static_cast<float>(random(1, 3)));
        const auto found = shown(points, light);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto taps = shown.taps(points[i]);
            double sum = 0.0, weight = 0.0;
            for (const auto& [texel, share] : taps) {
                sum += share * light[texel];
                weight += share;
            }
            ASSERT_GT(weight, 0.2);  // the texel around the point is listed
            fewer += taps.size() < 4;
            ASSERT_NEAR(found[i].x, sum / weight, 2e-4) << i;
        }
    }
    EXPECT_GT(fewer, 150);
}

// Of a smooth function the two sides of an edge differ by what lies between the nearest texels.
TEST(AtlasShow, HardlyJumpsAtTheEdgesOfACube) {
    Scene scene = test::plain_scene();
    test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), 1);
    const Shown shown(scene, 64);
    const auto found_near = [&](double from_edge) {
        std::vector<Point> points;
        for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
            for (int k = 0; k <= 40; ++k) {
                const double along = 0.05 + 0.9 * k / 40.0;
                points.push_back({t, along * (1.0 - from_edge), from_edge});
                points.push_back({t, from_edge, along * (1.0 - from_edge)});
                points.push_back({t, along * (1.0 - from_edge), (1.0 - along) * (1.0 - from_edge)});
            }
        }
        return points;
    };
    const std::vector<Point> points = found_near(1e-4);
    const auto found = shown(points, shown.light(slanted_light));
    const double texel = 1.0 / shown.layout.texels_per_metre;
    const double gradient = glm::length(glm::dvec3(0.7, -1.3, 0.4));
    int pairs = 0;
    double most = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            if (shown.layout.triangle_chart[points[i].triangle] ==
                shown.layout.triangle_chart[points[j].triangle])
                continue;
            const double apart =
                glm::distance(place_of(scene, points[i]), place_of(scene, points[j]));
            if (apart > 1e-3) continue;
            ++pairs;
            most = std::max(most, double(std::abs(found[i].x - found[j].x)));
        }
    EXPECT_GT(pairs, 200);
    EXPECT_LE(most, 2.0 * gradient * texel);
    EXPECT_GT(most, 0.0);
}

CLGI_IN_ALL_MODES(ChartsShown);

// Charts of a UV set may lie side by side, without an empty texel between them.
TEST_P(ChartsShown, LetsNothingBleedFromOneChartIntoTheNext) {
    Scene scene = test::plain_scene();
    for (const double x : {0.0, 3.0})
        test::add_quad(scene, {glm::dvec3(x, 0, 0), {x + 1, 0, 0}, {x + 1, 2, 0}, {x, 2, 0}});
    for (const float u : {0.0f, 0.5f})
        for (const glm::vec2 at : {glm::vec2(0, 0), {0.5, 0}, {0.5, 1}, {0, 1}})
            scene.uvs.emplace_back(u + at.x, at.y, 0, 0);
    const Shown shown(scene, 16, AtlasUvs::set_0);
    ASSERT_EQ(shown.layout.charts.size(), 2u);
    const std::vector<Point> points = random_points(scene, 500);
    const auto found =
        shown(points, shown.light([](const glm::dvec3& p) { return p.x < 2.0 ? 1.0 : 2.0; }));
    for (std::size_t i = 0; i < points.size(); ++i)
        ASSERT_FLOAT_EQ(found[i].x, points[i].triangle < 2 ? 1.0f : 2.0f) << i;
}

// A chart that fills its page: within half a texel of an edge there is no texel beyond, and the one
// at the edge counts in its place, not the one that follows it in the map.
TEST(AtlasShow, ReadsNothingBeyondThePagesEdges) {
    Scene scene = tilted_quad();
    for (const glm::vec2 at : {glm::vec2(0, 0), {1, 0}, {1, 1}, {0, 1}})
        scene.uvs.emplace_back(at.x, at.y, 0, 0);
    const Shown shown(scene, 15, AtlasUvs::set_0);
    ASSERT_EQ(shown.layout.texels.size(), 15u * 15u);
    std::vector<Point> points;
    const auto put = [&](double u, double v) {  // of the quad: 0 to 1 along its sides
        if (v < u)
            points.push_back({0, u - v, v});
        else
            points.push_back({1, u, v - u});
    };
    for (const double edge : {0.0, 0.001, 0.02, 0.03})
        for (int k = 0; k <= 100; ++k)
            for (const double at : {edge, 1.0 - edge}) {
                put(at, k / 100.0);
                put(k / 100.0, at);
            }
    std::vector<float> light;
    test::Random random(12);
    for (std::size_t i = 0; i < shown.layout.texels.size(); ++i)
        light.push_back(static_cast<float>(random(1, 3)));
    const auto found = shown(points, light);
    int sides[4] = {0, 0, 0, 0};
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec2 place = shown.texel_place(points[i]);
        sides[0] += place.x<0.5, sides[1] += place.x> 14.5;
        sides[2] += place.y<0.5, sides[3] += place.y> 14.5;
        double sum = 0.0, weight = 0.0;
        for (const auto& [texel, part] : shown.taps(points[i])) {
            sum += part * light[texel];
            weight += part;
        }
        ASSERT_NEAR(weight, 1.0, 1e-12) << i;
        for (int c = 0; c < 3; ++c)  // places as above; of lights up to 3 that differ by up to 2
            ASSERT_NEAR(found[i][c], sum * (c == 2 ? -3.0 : c + 1.0), 2e-4) << i;
    }
    for (const int side : sides) EXPECT_GT(side, 100);
}

// Where the point's own chart has no texel, those of others are taken, weighted alike.
TEST(AtlasShow, TakesOtherChartsWhereItsOwnHasNoTexel) {
    const Shown usual(tilted_quad(), 32);
    Shown strange = usual;
    strange.map.chart_of =
        test::upload(std::vector<std::uint32_t>(usual.layout.texels.size(), 1000u));
    const std::vector<Point> points = random_points(usual.world, 300);
    const std::vector<float> light = usual.light(slanted_light);
    EXPECT_EQ(strange(points, light), usual(points, light));
}

// A point beside its triangle has the light of the triangle's border.
TEST(AtlasShow, StaysOnTheTriangle) {
    const Shown shown(tilted_quad(), 48);
    const std::vector<Point> beside = {
        {0, -0.2, 0.3}, {1, 0.4, -0.1}, {0, 0.7, 0.6}, {1, 1.3, 0.0}};
    const std::vector<Point> on = {{0, 0.0, 0.3}, {1, 0.4, 0.0}, {0, 0.7, 0.3}, {1, 1.0, 0.0}};
    const std::vector<float> light = shown.light(slanted_light);
    const auto found = shown(beside, light), wanted = shown(on, light);
    for (std::size_t i = 0; i < on.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[i][c], wanted[i][c], 2e-5) << i;
}

TEST(AtlasShow, HasNoLightWhereNothingIs) {
    Scene scene = tilted_quad();
    test::add_triangle(scene, {0, 0, 0}, {1, 1, 1}, {2, 2, 2});  // without area: in no chart
    const Shown shown(scene, 16);
    const auto found = shown({{none, 0, 0}, {2, 0.3, 0.3}, {0, 0.3, 0.3}},
                             std::vector<float>(shown.layout.texels.size(), 5.0f));
    EXPECT_EQ(found[0], glm::vec3(0.0f));
    EXPECT_EQ(found[1], glm::vec3(0.0f));
    // A weighted mean of equal numbers.
    EXPECT_FLOAT_EQ(found[2].x, 5.0f);
    EXPECT_FLOAT_EQ(found[2].y, 10.0f);
    EXPECT_FLOAT_EQ(found[2].z, -15.0f);
}

TEST(AtlasShow, KeepsWhatIsNotFinite) {
    const Shown shown(tilted_quad(), 16);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> light(shown.layout.texels.size(), 1.0f);
    const std::vector<Point> points = random_points(shown.world, 50);
    for (int c = 0; c < 3; ++c) {
        glm::vec3 moved(0.0f);
        moved[c] = nan;
        for (const glm::vec3& value : shown(points, light, Storage::full, moved))
            EXPECT_TRUE(std::isnan(value.x) && std::isnan(value.z));
    }
    const std::uint32_t bad = shown.taps(points[7]).front().first;
    light[bad] = nan;
    const auto found = shown(points, light);
    for (std::size_t i = 0; i < points.size(); ++i) {
        bool reached = false;
        for (const auto& [texel, weight] : shown.taps(points[i]))
            reached |= texel == bad && weight > 1e-4;
        EXPECT_TRUE(!reached || std::isnan(found[i].y)) << i;
    }
    EXPECT_TRUE(std::isnan(found[7].x));
}

TEST(AtlasShow, WritesHalvesInHalfStorage) {
    const Shown shown(tilted_quad(), 32);
    const std::vector<Point> points = random_points(shown.world, 77);
    const auto light = shown.light(slanted_light);
    const auto full = shown(points, light), half = shown(points, light, Storage::half);
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < 3; ++c)  // 11 bits
            EXPECT_NEAR(half[i][c], full[i][c], 0x1p-11f * std::abs(full[i][c])) << i;
}

TEST(AtlasShow, RefusesWhatIsTooSmall) {
    const Shown shown(tilted_quad(), 16);
    const AtlasPasses passes(test::programs());
    const cl::Buffer any = test::empty<float>(1 << 14);
    const GBuffer points{any, any, 16, Storage::full};
    ShowParams params{5, 16, 2, shown.map.texel_count, 512, 16, 1, 0};
    const auto show = [&](const GBuffer& g, const AtlasMap& m, const cl::Buffer& light,
                          const cl::Buffer& out) {
        passes.show(test::device().queue, params, shown.scene, g, m, light, out);
    };
    EXPECT_NO_THROW(show(points, shown.map, any, any));
    const cl::Buffer small = test::empty<char>(4);
    EXPECT_THROW(show({small, any, 16, Storage::full}, shown.map, any, any), Error);
    EXPECT_THROW(show({any, small, 16, Storage::full}, shown.map, any, any), Error);
    for (cl::Buffer AtlasMap::*part :
         {&AtlasMap::corners, &AtlasMap::charts, &AtlasMap::map, &AtlasMap::chart_of}) {
        AtlasMap map = shown.map;
        map.*part = small;
        EXPECT_THROW(show(points, map, any, any), Error);
    }
    EXPECT_THROW(show(points, shown.map, small, any), Error);
    EXPECT_THROW(show(points, shown.map, any, small), Error);
    for (std::uint32_t ShowParams::*word : {&ShowParams::stride, &ShowParams::texel_stride}) {
        const ShowParams good = params;
        params.*word = 1;
        EXPECT_THROW(show(points, shown.map, any, any), Error);
        params = good;
    }
    params.triangle_count = 3;
    EXPECT_THROW(show(points, shown.map, any, any), Error);
    params.triangle_count = 2;
    params.point_count = 0;
    EXPECT_NO_THROW(show(points, shown.map, any, any));
    test::device().queue.finish();
}

}  // namespace
}  // namespace clgi
