// The lookup of a light atlas at points of surfaces: bilinear inside charts, nothing over their
// borders.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "frames.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

struct Point {
    std::uint32_t triangle;  // of the scene
    double b1, b2;
};

std::array<glm::dvec3, 3> corners_of(const Scene& scene, std::uint32_t triangle) {
    std::array<glm::dvec3, 3> out;
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = scene.positions[scene.triangles[triangle].vertex[k]];
    return out;
}

glm::dvec3 place_of(const Scene& scene, const Point& point) {
    const auto corner = corners_of(scene, point.triangle);
    return corner[0] + point.b1 * (corner[1] - corner[0]) + point.b2 * (corner[2] - corner[0]);
}

// A scene with its atlas, and what is on the device of both.
struct Shown {
    Shown(const Scene& of, int size, AtlasUvs uvs = AtlasUvs::charts, int pages = 1) : world(of) {
        AtlasOptions options;
        options.most_pages = pages;
        options.size = size;
        options.uvs = uvs;
        layout = make_atlas(world, make_patches(world).triangle_patch, options);
        const std::vector<std::uint32_t>& order = scene.triangle_order();
        of_device.resize(order.size());
        std::vector<glm::vec2> corners;
        std::vector<std::uint32_t> charts, listed(texel_room(), ATLAS_NONE), chart_of;
        for (std::uint32_t i = 0; i < order.size(); ++i) {
            of_device[order[i]] = i;
            for (std::size_t k = 0; k < 3; ++k) corners.push_back(layout.uvs[3 * order[i] + k]);
            charts.push_back(layout.triangle_page[order[i]]);
            charts.push_back(layout.triangle_chart[order[i]]);
        }
        for (std::uint32_t i = 0; i < layout.texels.size(); ++i) {
            listed[layout.texels[i].texel] = i;
            chart_of.push_back(layout.texels[i].chart);
        }
        map = {test::upload(corners), test::upload(charts), test::upload(listed),
               test::upload(chart_of)};
        map.size = static_cast<std::uint32_t>(layout.size);
        map.pages = static_cast<std::uint32_t>(layout.pages);
        map.texel_count = static_cast<std::uint32_t>(layout.texels.size());
        index = listed;
    }

    std::size_t texel_room() const {
        return std::size_t(layout.pages) * std::size_t(layout.size) * std::size_t(layout.size);
    }

    // light: by texel of the layout, the same function of its place in all three channels but for
    // factors 1, 2 and -3.
    std::vector<glm::vec3> operator()(const std::vector<Point>& points,
                                      const std::vector<float>& light,
                                      Storage storage = test::usual_build().storage,
                                      const glm::vec3& moved = glm::vec3(0.0f)) const {
        const auto count = static_cast<std::uint32_t>(points.size());
        const std::uint32_t stride = plane_stride(count), texels = plane_stride(light.size());
        std::vector<float> planes(GBUFFER_PLANES * stride), values(3 * texels);
        std::vector<std::int32_t> ids(GBUFFER_ID_PLANES * stride, -1);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (points[i].triangle == none) continue;
            const glm::vec3 at = scene.frame().to_local(place_of(world, points[i])) + moved;
            for (int c = 0; c < 3; ++c) planes[c * stride + i] = at[c];
            ids[GBUFFER_TRIANGLE * stride + i] =
                static_cast<std::int32_t>(of_device[points[i].triangle]);
        }
        const float factor[3] = {1.0f, 2.0f, -3.0f};
        for (std::size_t i = 0; i < light.size(); ++i)
            for (int c = 0; c < 3; ++c) values[c * texels + i] = factor[c] * light[i];
        GBuffer gbuffer{test::upload(planes), test::upload(ids), stride, storage};
        const ShowParams params{count,           stride, scene.info().triangle_count,
                                map.texel_count, texels, map.size,
                                map.pages,       0};
        const cl::Buffer out(test::device().context, CL_MEM_READ_WRITE,
                             irradiance_bytes(storage, stride));
        BuildOptions build = test::usual_build();
        build.storage = storage;
        AtlasPasses(test::programs(), build)
            .show(test::device().queue, params, scene, gbuffer, map, test::upload(values), out);
        if (storage == Storage::full)
            return test::vectors(test::device().queue, out, stride, count);
        std::vector<glm::vec3> halves(count);
        const auto raw = test::download<std::uint16_t>(out, 3 * std::size_t{stride});
        for (std::uint32_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c)
                halves[i][c] = glm::unpackHalf1x16(raw[static_cast<std::size_t>(c) * stride + i]);
        return halves;
    }

    // Where a point lies in its page, texels.
    glm::dvec2 texel_place(const Point& point) const {
        const glm::vec2* uv = &layout.uvs[3 * std::size_t{point.triangle}];
        return glm::dvec2(uv[0]) + point.b1 * glm::dvec2(uv[1] - uv[0]) +
               point.b2 * glm::dvec2(uv[2] - uv[0]);
    }

    // The listed texels of the point's chart among the four nearest, with their weights.
    std::vector<std::pair<std::uint32_t, double>> taps(const Point& point) const {
        std::vector<std::pair<std::uint32_t, double>> out;
        const glm::dvec2 at = texel_place(point) - 0.5, low = glm::floor(at), part = at - low;
        const std::size_t page = layout.triangle_page[point.triangle];
        const auto side = static_cast<std::size_t>(layout.size);
        for (int tap = 0; tap < 4; ++tap) {
            const int right = tap & 1, below = tap >> 1;
            const auto column =
                static_cast<std::size_t>(std::clamp(int(low.x) + right, 0, layout.size - 1));
            const auto row =
                static_cast<std::size_t>(std::clamp(int(low.y) + below, 0, layout.size - 1));
            const std::uint32_t texel = index[(page * side + row) * side + column];
            if (texel == ATLAS_NONE ||
                layout.texels[texel].chart != layout.triangle_chart[point.triangle])
                continue;
            out.push_back(
                {texel, (right ? part.x : 1.0 - part.x) * (below ? part.y : 1.0 - part.y)});
        }
        return out;
    }

    std::vector<float> light(const std::function<double(const glm::dvec3&)>& of) const {
        std::vector<float> out;
        for (const AtlasTexel& texel : layout.texels)
            out.push_back(
                static_cast<float>(of(place_of(world, {texel.triangle, texel.b1, texel.b2}))));
        return out;
    }

    Scene world;
    DeviceScene scene = test::on_device(world);
    AtlasLayout layout;
    AtlasMap map;
    std::vector<std::uint32_t> of_device, index;
};

std::vector<Point> random_points(const Scene& scene, std::size_t count) {
    test::Random random(4);
    std::vector<Point> out;
    for (std::size_t i = 0; i < count; ++i) {
        const int last = static_cast<int>(scene.triangles.size()) - 1;
        const auto triangle = static_cast<std::uint32_t>(random.integer(0, last));
        const double a = std::sqrt(random(0, 1)), b = random(0, 1);
        out.push_back({triangle, a * (1.0 - b), a * b});
    }
    return out;
}

Scene tilted_quad() {
    Scene scene = test::plain_scene();
    const glm::dvec3 at(3, -2, 5), u(1.9, 0.4, -0.3), v(-0.2, 0.7, 1.1);
    test::add_quad(scene, {at, at + u, at + u + v, at + v});
    return scene;
}

double slanted(const glm::dvec3& p) { return 4.0 + 0.7 * p.x - 1.3 * p.y + 0.4 * p.z; }

TEST(AtlasShow, IsExactForALinearFunctionInsideAChart) {
    const Shown shown(tilted_quad(), 48);
    const std::vector<Point> points = random_points(shown.world, 1000);
    const auto found = shown(points, shown.light(slanted));
    int inside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto taps = shown.taps(points[i]);
        // At the edge of the page a texel counts twice, in the place of one beyond.
        bool centres =
            taps.size() == 4 && taps[0].first != taps[1].first && taps[0].first != taps[2].first;
        for (const auto& [texel, weight] : taps) centres &= shown.layout.texels[texel].centre;
        if (!centres) continue;
        ++inside;
        const double wanted = slanted(place_of(shown.world, points[i]));
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
    const auto found = shown(points, shown.light(slanted));
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

// Where the point's own chart has no texel, those of others are taken, weighted alike.
TEST(AtlasShow, TakesOtherChartsWhereItsOwnHasNoTexel) {
    const Shown usual(tilted_quad(), 32);
    Shown strange = usual;
    strange.map.chart_of =
        test::upload(std::vector<std::uint32_t>(usual.layout.texels.size(), 1000u));
    const std::vector<Point> points = random_points(usual.world, 300);
    const std::vector<float> light = usual.light(slanted);
    EXPECT_EQ(strange(points, light), usual(points, light));
}

// A point beside its triangle has the light of the triangle's border.
TEST(AtlasShow, StaysOnTheTriangle) {
    const Shown shown(tilted_quad(), 48);
    const std::vector<Point> beside = {
        {0, -0.2, 0.3}, {1, 0.4, -0.1}, {0, 0.7, 0.6}, {1, 1.3, 0.0}};
    const std::vector<Point> on = {{0, 0.0, 0.3}, {1, 0.4, 0.0}, {0, 0.7, 0.3}, {1, 1.0, 0.0}};
    const std::vector<float> light = shown.light(slanted);
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
    const auto light = shown.light(slanted);
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
