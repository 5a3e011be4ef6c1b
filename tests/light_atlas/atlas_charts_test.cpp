// Charts made of regions: true to scale, apart from each other, full pages, and what is split.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>

#include "atlas_checks.hpp"
#include "lab/scenes/rooms.hpp"
#include "methods/light_atlas/flatten.hpp"
#include "methods/light_atlas/overlap.hpp"

namespace clgi {
namespace {

using test::made_charts;

AtlasLayout sound_atlas(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                        const AtlasOptions& options) {
    AtlasLayout atlas = make_atlas(scene, region_of, options);
    test::expect_sound(scene, atlas);
    test::expect_apart(atlas, options.padding);
    return atlas;
}

Scene cube() {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-1, -1, -1}, {1, 2, 1}, 1);
    return scene;
}

// Squares of this side, far enough apart to be no neighbours.
Scene squares(int count, double side) {
    Scene scene = test::plain_scene();
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 a(2 * side * i, 0, 0), x(side, 0, 0), z(0, 0, -side);
        test::add_quad(scene, {a, a + x, a + x + z, a + z});
    }
    return scene;
}

TEST(AtlasCharts, AreTrueToScale) {
    for (const std::uint32_t each : {1u, 2u})
        for (const int size : {64, 100, 512}) {
            for (const Scene& scene : {cube(), test::turned(cube())}) {
                const AtlasLayout atlas =
                    sound_atlas(scene, test::regions(scene, each), made_charts(size));
                EXPECT_EQ(atlas.charts.size(), 12u / each);
                EXPECT_EQ(atlas.skipped_area, 0.0);
                test::expect_true_to_scale(scene, atlas);
            }
        }
}

TEST(AtlasCharts, AreTrueToScaleFarFromTheOrigin) {
    const Scene scene = test::turned(cube(), {3e7, -1e7, 2e7});
    const AtlasLayout atlas = sound_atlas(scene, test::regions(scene, 2), made_charts(256));
    ASSERT_EQ(atlas.charts.size(), 6u);
    const AtlasLayout near =
        make_atlas(test::turned(cube()), test::regions(scene, 2), made_charts(256));
    EXPECT_NEAR(atlas.texels_per_metre, near.texels_per_metre, 1e-6 * near.texels_per_metre);
    test::expect_true_to_scale(scene, atlas);
}

// A rectangle at any angle lies straight in its box and in the middle of it.
TEST(AtlasCharts, LieUprightInTheSmallestBox) {
    for (const double angle : {0.0, 0.3, 1.1, 2.5, 4.0}) {
        const glm::dvec2 x(std::cos(angle), std::sin(angle)), y(-x.y, x.x);
        const glm::dvec2 o(17, -5);
        std::vector<glm::dvec2> corners = {o, o + 2.0 * x,           o + 2.0 * x + 7.0 * y,
                                           o, o + 2.0 * x + 7.0 * y, o + 7.0 * y};
        const glm::dvec2 extent = turn_upright(corners);
        EXPECT_NEAR(extent.x, 7.0, 1e-12);
        EXPECT_NEAR(extent.y, 2.0, 1e-12);
        for (const glm::dvec2& corner : corners) {
            EXPECT_NEAR(std::min(corner.x, 7.0 - corner.x), 0.0, 1e-12);
            EXPECT_NEAR(std::min(corner.y, 2.0 - corner.y), 0.0, 1e-12);
        }
        // Not mirrored.
        const glm::dvec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
        EXPECT_NEAR(a.x * b.y - a.y * b.x, 14.0, 1e-12);
    }
    Scene scene = squares(1, 1.0);
    AtlasOptions options = made_charts(64);
    options.texels_per_metre = 10.5;
    const AtlasLayout atlas = sound_atlas(test::turned(scene), test::regions(scene, 0), options);
    EXPECT_EQ(atlas.charts[0].width, 11);
    // 11 by 11 texels, those at the edge three quarters full, at the corners nine sixteenths.
    ASSERT_EQ(atlas.texels.size(), 121u);
    for (const AtlasTexel& texel : atlas.texels) {
        const glm::dvec2 at =
            test::corner_of(texel, 64) - glm::dvec2(atlas.charts[0].column, atlas.charts[0].row);
        const double wanted =
            (at.x == 0 || at.x == 10 ? 0.75 : 1.0) * (at.y == 0 || at.y == 10 ? 0.75 : 1.0);
        EXPECT_NEAR(double{texel.coverage}, wanted, 1e-6);
    }
}

TEST(AtlasCharts, OfATenThousandthOfTheAtlasHaveATexelEach) {
    const Scene scene = squares(10000, 0.03);
    AtlasOptions options = made_charts(512);
    options.texels_per_metre = 10.0;
    const AtlasLayout atlas = sound_atlas(scene, test::regions(scene, 2), options);
    ASSERT_EQ(atlas.charts.size(), 10000u);
    ASSERT_EQ(atlas.texels.size(), 10000u);
    for (const AtlasTexel& texel : atlas.texels) EXPECT_NEAR(double{texel.coverage}, 0.09, 1e-7);
    test::expect_true_to_scale(scene, atlas);
    // 103 * 103 boxes of 5 texels would fit on 516 texels, not one more row.
    options.size = 490;
    EXPECT_THROW(make_atlas(scene, test::regions(scene, 2), options), InputError);
    options.most_pages = 2;
    EXPECT_EQ(sound_atlas(scene, test::regions(scene, 2), options).pages, 2);
}

TEST(AtlasCharts, KeepTheirScaleBesideAHugeOne) {
    Scene scene = squares(400, 0.001);
    test::add_floor(scene, 5.0, 3.0);
    const AtlasLayout atlas = sound_atlas(scene, test::regions(scene, 2), made_charts(256));
    ASSERT_EQ(atlas.charts.size(), 401u);
    EXPECT_GT(atlas.charts[400].width, 180);
    test::expect_true_to_scale(scene, atlas);
}

TEST(AtlasCharts, SplitWhereTheyFold) {
    // All of a cube, and a sphere, in one region.
    Scene scene = test::turned(cube());
    AtlasLayout atlas = sound_atlas(scene, test::regions(scene, 0), made_charts(128));
    EXPECT_EQ(atlas.charts.size(), 6u);
    EXPECT_EQ(atlas.skipped_area, 0.0);
    test::expect_true_to_scale(scene, atlas);

    scene = test::sphere(24, 36);
    atlas = sound_atlas(scene, test::regions(scene, 0), made_charts(256));
    EXPECT_GE(atlas.charts.size(), 6u);
    EXPECT_LE(atlas.charts.size(), 40u);
    EXPECT_EQ(atlas.skipped_area, 0.0);
    const double texel = 1.0 / (atlas.texels_per_metre * atlas.texels_per_metre);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const glm::dvec2 a = atlas.uvs[3 * t], b = atlas.uvs[3 * t + 1], c = atlas.uvs[3 * t + 2];
        const double laid = ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) * texel;
        const double whole = glm::length(geometry::doubled_area(scene, t));
        // Float coordinates of a triangle of a few texels.
        EXPECT_GE(laid, (least_share - 1e-3) * whole) << t;
        EXPECT_LE(laid, (1.0 + 1e-3) * whole) << t;
    }
    for (const AtlasTexel& texel_of : atlas.texels)
        EXPECT_LE(double{texel_of.area}, double{texel_of.coverage} * texel / least_share * 1.00001);
}

TEST(AtlasCharts, OfASphereCutByAngleAreOneARegion) {
    const Scene scene = test::sphere(24, 36);
    // By the axis that a normal is nearest to.
    std::vector<std::uint32_t> region_of(scene.triangles.size());
    for (std::size_t t = 0; t < region_of.size(); ++t) {
        const glm::dvec3 normal = geometry::doubled_area(scene, t), size = glm::abs(normal);
        const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
        region_of[t] = static_cast<std::uint32_t>(10 * axis + (normal[axis] < 0.0));
    }
    const AtlasLayout atlas = sound_atlas(scene, region_of, made_charts(256));
    ASSERT_EQ(atlas.charts.size(), 6u);
    for (const AtlasTexel& texel : atlas.texels)
        EXPECT_EQ(atlas.charts[texel.chart].region, region_of[texel.triangle]);
}

// A stair that winds two and a half times around its axis lies on itself; so do parallel sheets.
TEST(AtlasCharts, SplitWhereTheyLieOnThemselves) {
    Scene scene = test::plain_scene();
    const auto at = [](double radius, int i) {
        return glm::dvec3(radius * std::cos(0.1 * i), 0.01 * i, -radius * std::sin(0.1 * i));
    };
    for (int i = 0; i < 157; ++i)
        test::add_quad(scene, {at(1, i), at(3, i), at(3, i + 1), at(1, i + 1)});
    AtlasLayout atlas = sound_atlas(scene, test::regions(scene, 0), made_charts(256));
    EXPECT_GE(atlas.charts.size(), 3u);
    EXPECT_LE(atlas.charts.size(), 6u);

    scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    test::add_floor(scene, 1.0, 0.5);
    atlas = sound_atlas(scene, test::regions(scene, 0), made_charts(64));
    EXPECT_EQ(atlas.triangle_chart[0], atlas.triangle_chart[1]);
    EXPECT_EQ(atlas.triangle_chart[2], atlas.triangle_chart[3]);
    EXPECT_NE(atlas.triangle_chart[0], atlas.triangle_chart[2]);
    test::expect_true_to_scale(scene, atlas);
}

TEST(AtlasCharts, StayWholeWhereVerticesWereRounded) {
    Scene scene = test::plain_scene();
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 10; ++x)
            test::add_quad(scene,
                           {glm::dvec3(x, y, 0), {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
    test::Random random(3);
    for (glm::dvec3& position : scene.positions)
        position += glm::dvec3(random(-1e-6, 1e-6), random(-1e-6, 1e-6), random(-1e-6, 1e-6));
    EXPECT_EQ(sound_atlas(scene, test::regions(scene, 0), made_charts(64)).charts.size(), 1u);
}

// The part of one triangle within another, by clipping.
double common_area(const glm::dvec2* a, const glm::dvec2* b) {
    std::vector<glm::dvec2> polygon(b, b + 3);
    const auto side = [](const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& p) {
        return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
    };
    for (int k = 0; k < 3; ++k) {
        std::vector<glm::dvec2> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const glm::dvec2 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
            const double at_p = side(a[k], a[(k + 1) % 3], p), at_q = side(a[k], a[(k + 1) % 3], q);
            if (at_p >= 0.0) kept.push_back(p);
            if ((at_p < 0.0) != (at_q < 0.0)) kept.push_back(glm::mix(p, q, at_p / (at_p - at_q)));
        }
        polygon = kept;
    }
    double area = 0.0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        area += 0.5 * side(polygon[0], polygon[i - 1], polygon[i]);
    return area;
}

TEST(AtlasOverlap, IsWhatAllPairsSay) {
    test::Random random(11);
    std::vector<glm::dvec2> corners;
    while (corners.size() < 3 * 400) {
        const glm::dvec2 a(random(0, 5), random(0, 2));
        const double size = random(0, 1) < 0.1 ? 2.0 : 0.2;
        const auto offset = [&] { return glm::dvec2(random(-size, size), random(-size, size)); };
        const glm::dvec2 u = offset(), v = offset();
        const bool left = u.x * v.y - u.y * v.x > 0.0;
        corners.insert(corners.end(), {a, a + (left ? u : v), a + (left ? v : u)});
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> wanted;
    for (std::uint32_t b = 0; b < 400; ++b)
        for (std::uint32_t a = 0; a < b; ++a)
            if (common_area(&corners[3 * a], &corners[3 * b]) > 0.0) wanted.emplace_back(a, b);
    std::sort(wanted.begin(), wanted.end());
    EXPECT_GT(wanted.size(), 1000u);
    EXPECT_EQ(overlapping(corners, 0.0), wanted);
}

// Side by side across the diagonal: the boxes of all of them overlap.
TEST(AtlasOverlap, IsFoundAmongSlivers) {
    std::vector<glm::dvec2> corners;
    for (int i = 0; i < 10000; ++i) {
        const glm::dvec2 a(i * 2e-4, -i * 2e-4), along(3, 3), b(2e-4, -2e-4);
        corners.insert(corners.end(), {a, a + b, a + along});
    }
    EXPECT_TRUE(overlapping(corners, 1e-9).empty());
    corners.insert(corners.end(), {{1.5, 1.2}, {1.55, 1.2}, {1.52, 1.25}});
    EXPECT_GT(overlapping(corners, 1e-9).size(), 100u);
}

TEST(AtlasOverlap, IsWhatLiesOnEachOtherNotSideBySide) {
    test::Random random(7);
    std::vector<glm::dvec2> corners;
    const auto add = [&](glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
        corners.insert(corners.end(), {a, b, c});
    };
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) {
            add({x, y}, {x + 1, y}, {x + 1, y + 1});
            add({x, y}, {x + 1, y + 1}, {x, y + 1});
        }
    EXPECT_TRUE(overlapping(corners, 1e-9).empty());
    for (glm::dvec2& corner : corners)
        corner += glm::dvec2(random(-1e-6, 1e-6), random(-1e-6, 1e-6));
    EXPECT_TRUE(overlapping(corners, 1e-5).empty());
    EXPECT_FALSE(overlapping(corners, 1e-9).empty());
    // A star over corner (10, 10), off the middle, meets the six triangles around it.
    add({9.8, 9.9}, {10.3, 9.95}, {10.05, 10.4});
    const auto pairs = overlapping(corners, 1e-5);
    EXPECT_EQ(pairs.size(), 6u);
    for (const auto& [a, b] : pairs) EXPECT_EQ(b, 800u);
}

TEST(AtlasCharts, LeaveOutWhatHasNoAreaOrNoRegion) {
    Scene scene = cube();
    test::add_triangle(scene, {0, 0, 0}, {1, 1, 1}, {3, 3, 3});
    test::add_triangle(scene, {0, 5, 0}, {0, 5, 0}, {0, 5, 0});
    std::vector<std::uint32_t> region_of = test::regions(scene, 2);
    region_of[2] = region_of[3] = test::no_region;
    const AtlasLayout atlas = sound_atlas(scene, region_of, made_charts(64));
    EXPECT_EQ(atlas.charts.size(), 5u);
    EXPECT_NEAR(atlas.skipped_area, 0.5 * glm::length(geometry::doubled_area(scene, 2)) * 2, 1e-9);
    for (const std::size_t t : {2u, 3u, 12u, 13u}) {
        EXPECT_EQ(atlas.triangle_chart[t], test::no_region);
        EXPECT_EQ(atlas.triangle_page[t], test::no_region);
    }
    Scene flat = test::plain_scene();
    test::add_triangle(flat, {0, 0, 0}, {1, 1, 1}, {3, 3, 3});
    EXPECT_THROW(make_atlas(flat, {0}, made_charts(64)), InputError);
}

TEST(AtlasCharts, FitTheSmallestPages) {
    const Scene one = squares(1, 3.0);
    for (const int size : {1, 4}) {
        const AtlasLayout atlas = sound_atlas(one, {5, 5}, made_charts(size));
        EXPECT_EQ(atlas.texels.size(), static_cast<std::size_t>(size * size));
        EXPECT_NEAR(atlas.texels_per_metre, size / 3.0, 1e-9);
        EXPECT_EQ(atlas.charts[0].region, 5u);
        for (const AtlasTexel& texel : atlas.texels) EXPECT_FLOAT_EQ(texel.coverage, 1.0f);
    }
    const Scene six = cube();
    EXPECT_THROW(make_atlas(six, test::regions(six, 2), made_charts(1)), InputError);
    EXPECT_THROW(make_atlas(six, test::regions(six, 2), made_charts(4)), InputError);
    EXPECT_EQ(sound_atlas(six, test::regions(six, 2), made_charts(1, 2, 6)).pages, 6);
    EXPECT_EQ(sound_atlas(six, test::regions(six, 2), made_charts(4, 1, 6)).charts.size(), 6u);
}

TEST(AtlasCharts, FindThePageThatHoldsThem) {
    const Scene six = cube();
    AtlasOptions options = made_charts(1);
    options.largest_size = 8;  // charts of a texel with two around it need 11 x 11 at least
    EXPECT_THROW(make_atlas(six, test::regions(six, 2), options), InputError);
    options.largest_size = 16;
    const AtlasLayout atlas = sound_atlas(six, test::regions(six, 2), options);
    EXPECT_EQ(atlas.size, 16);
    EXPECT_THROW(make_atlas(six, test::regions(six, 2), made_charts(8)), InputError);
    options.size = 32;  // what fits stays as it is, also above the largest size
    EXPECT_EQ(make_atlas(six, test::regions(six, 2), options).size, 32);
    options = made_charts(7);  // 14 by doubling, and 28 is too large
    options.largest_size = 20;
    EXPECT_EQ(sound_atlas(six, test::regions(six, 2), options).size, 14);
    options.largest_size = 13;
    EXPECT_THROW(make_atlas(six, test::regions(six, 2), options), InputError);
    // 64 pages of 8000 texels a side have fewer than 2^32; the next doubling would not.
    options = made_charts(1000, 2, 64);
    options.largest_size = 8192;
    EXPECT_EQ(make_atlas(six, test::regions(six, 2), options).size, 1000);
}

TEST(AtlasCharts, FillTheirPages) {
    const Scene scene = corridor();
    // Coplanar triangles that follow one another.
    std::vector<std::uint32_t> region_of(scene.triangles.size(), 0);
    for (std::size_t t = 1; t < region_of.size(); ++t) {
        const glm::dvec3 a = glm::normalize(geometry::doubled_area(scene, t - 1)),
                         b = glm::normalize(geometry::doubled_area(scene, t));
        region_of[t] = region_of[t - 1] + (t % 2 == 0 || glm::dot(a, b) < 0.999);
    }
    for (const int pages : {1, 3}) {
        const AtlasLayout atlas = sound_atlas(scene, region_of, made_charts(512, 2, pages));
        EXPECT_EQ(atlas.pages, pages);
        test::expect_true_to_scale(scene, atlas);
        double boxes = 0.0;
        for (const AtlasChart& chart : atlas.charts)
            boxes += (chart.width + 4.0) * (chart.height + 4.0);
        EXPECT_GT(boxes, 0.75 * 512 * 512 * pages);
        const AtlasLayout again = make_atlas(scene, region_of, made_charts(512, 2, pages));
        EXPECT_EQ(again.uvs, atlas.uvs);
        EXPECT_EQ(again.texels.size(), atlas.texels.size());
    }
}

TEST(AtlasOptionsRange, IsChecked) {
    const Scene scene = cube();
    const auto wrong = [&](auto&& change) {
        AtlasOptions options = made_charts(64);
        change(options);
        EXPECT_THROW(make_atlas(scene, test::regions(scene, 2), options), Error);
    };
    wrong([](AtlasOptions& o) { o.size = 0; });
    wrong([](AtlasOptions& o) { o.size = 8193; });
    wrong([](AtlasOptions& o) { o.largest_size = -1; });
    wrong([](AtlasOptions& o) { o.largest_size = 8193; });
    wrong([](AtlasOptions& o) { o.padding = 0; });
    wrong([](AtlasOptions& o) { o.padding = 65; });
    wrong([](AtlasOptions& o) { o.most_pages = 0; });
    wrong([](AtlasOptions& o) { o.most_pages = 64, o.size = 8192; });
    wrong([](AtlasOptions& o) { o.most_pages = 64, o.largest_size = 8192; });
    wrong([](AtlasOptions& o) { o.texels_per_metre = -1.0; });
    wrong([](AtlasOptions& o) { o.texels_per_metre = NAN; });
    wrong([](AtlasOptions& o) { o.texels_per_metre = 1e300; });
    wrong([](AtlasOptions& o) { o.texels_per_metre = 30.0; });
    EXPECT_THROW(make_atlas(scene, {0, 1}, made_charts(64)), Error);
}

}  // namespace
}  // namespace clgi
