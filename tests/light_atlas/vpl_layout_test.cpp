// VPLs and sample points: areas against closed forms, membership against brute force, evenness.
// SPDX-License-Identifier: MIT
#include "clgi/advanced/vpl_layout.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>

#include "lab/scenes/rooms.hpp"
#include "scenes.hpp"
#include "walls.hpp"

namespace clgi {
namespace {

using test::corner;
using test::least_distance;
using test::position;
using test::positions;

// Does a triangle of another region meet the way between two points, a 64th of its length above the
// surface? Along the surface only: not where that bends away from under it.
bool divided(const Scene& scene, const Patches& patches, const VplLayout& layout,
             const SamplePoint& a, const SamplePoint& b, double side) {
    const glm::dvec3 from = position(scene, a), way = position(scene, b) - from;
    const glm::dvec3 n = side * glm::normalize(test::normal_of(scene, a.triangle));
    const glm::dvec3 m = side * glm::normalize(test::normal_of(scene, b.triangle));
    const double lift = glm::length(way) / 64.0;
    if (glm::dot(way, n) < -lift || glm::dot(way, m) > lift) return false;
    const glm::dvec3 start = from + lift * n, end = from + way + lift * m;
    const auto region = [&](std::uint32_t t) {
        const std::uint32_t patch = patches.triangle_patch[t];
        return patch == no_index ? no_index : layout.patch_region[patch];
    };
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        if (region(t) == region(a.triangle)) continue;
        // Both ends on different sides of its plane, and it around the line: signs of volumes.
        const glm::dvec3 p = corner(scene, t, 0) - start, q = corner(scene, t, 1) - start,
                         r = corner(scene, t, 2) - start, d = end - start;
        const glm::dvec3 across = glm::cross(q - p, r - p);
        if (glm::dot(p, across) * glm::dot(p - d, across) > 0.0) continue;
        const double u = glm::dot(d, glm::cross(p, q)), v = glm::dot(d, glm::cross(q, r)),
                     w = glm::dot(d, glm::cross(r, p));
        if ((u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0)) return true;
    }
    return false;
}

// What must hold for any layout. Every stride-th sample is checked against all VPLs; with 0 none
// is, where distances are not what counts on narrow regions.
void expect_consistent(const Scene& scene, const Patches& patches, const VplLayout& layout,
                       std::size_t stride = 1) {
    const auto region_of = [&](std::uint32_t t) {
        return layout.patch_region.at(patches.triangle_patch[t]);
    };
    std::vector<double> region_area(layout.region_count), placed(layout.region_count);
    double area = 0.0;
    for (std::size_t p = 0; p < patches.patches.size(); ++p) {
        const double sides = patches.patches[p].double_sided ? 2.0 : 1.0;
        region_area.at(layout.patch_region[p]) += sides * patches.patches[p].area;
        area += sides * patches.patches[p].area;
    }
    EXPECT_NEAR(layout.area, area, 1e-12 * area);
    EXPECT_NEAR(layout.sample_area * double(layout.samples.size()), area, 1e-12 * area);
    const std::vector<glm::dvec3> at = positions(scene, layout.vpls);
    std::uint32_t next = 0, outside = 0, strangers = 0, not_nearest = 0;
    const auto inside = [](const auto& p) {
        return p.b1 >= 0.0f && p.b2 >= 0.0f && 1.0f - p.b1 - p.b2 >= 0.0f;
    };
    for (const VplSite& vpl : layout.vpls) {
        EXPECT_EQ(vpl.first_sample, next);
        EXPECT_GE(vpl.sample_count, 1u);
        next += vpl.sample_count;
        EXPECT_EQ(region_of(vpl.triangle), vpl.region);
        outside += !inside(vpl);
        EXPECT_GT(vpl.area, 0.0f);
        placed[vpl.region] += double{vpl.area};
        const bool both = scene.materials[scene.triangles[vpl.triangle].material].double_sided;
        EXPECT_TRUE(both || !vpl.back);
    }
    ASSERT_EQ(next, layout.samples.size());
    for (std::uint32_t r = 0; r < layout.region_count; ++r)
        EXPECT_NEAR(placed[r], region_area[r], 1e-6 * region_area[r]) << r;  // floats
    for (std::size_t v = 0; v < layout.vpls.size(); ++v) {
        const VplSite& vpl = layout.vpls[v];
        for (std::uint32_t i = 0; i < vpl.sample_count; ++i) {
            const SamplePoint& sample = layout.samples[vpl.first_sample + i];
            outside += !inside(sample);
            strangers += region_of(sample.triangle) != vpl.region;
            if (stride == 0 || (vpl.first_sample + i) % stride != 0) continue;
            const glm::dvec3 p = position(scene, sample);
            const double mine = glm::length(p - at[v]);
            for (std::size_t other = 0; other < layout.vpls.size(); ++other) {
                const VplSite& site = layout.vpls[other];
                if (site.region != vpl.region || site.back != vpl.back) continue;
                if (!(glm::length(p - at[other]) < mine * (1 - 1e-9) - 1e-12)) continue;
                const SamplePoint there{site.triangle, site.b1, site.b2};
                const bool both =
                    scene.materials[scene.triangles[vpl.triangle].material].double_sided;
                not_nearest += !divided(scene, patches, layout, sample, there, 1.0) &&
                               !(both && divided(scene, patches, layout, sample, there, -1.0));
            }
        }
    }
    EXPECT_EQ(outside, 0u);
    EXPECT_EQ(strangers, 0u);
    EXPECT_EQ(not_nearest, 0u);
}

TEST(VplLayout, DividesACubeEquallyAndKeepsOffItsEdges) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {0, 0, 0}, {1, 1, 1}, -1);
    const Patches patches = make_patches(scene);
    for (const std::uint32_t n : {6u, 96u, 600u}) {
        const VplLayout layout = place_vpls(scene, patches, {.count = n, .samples_per_vpl = 10});
        expect_consistent(scene, patches, layout);
        ASSERT_EQ(layout.vpls.size(), n);
        EXPECT_EQ(layout.region_count, 6u);
        std::vector<std::vector<glm::dvec3>> face(6);
        const double spacing = std::sqrt(6.0 / n);
        for (const VplSite& vpl : layout.vpls) {
            const glm::dvec3 p = position(scene, vpl);
            face[vpl.region].push_back(p);
            // One coordinate is that of the face; the others keep off 0 and 1.
            double q[3];
            for (int k = 0; k < 3; ++k) q[k] = std::min(p[k], 1 - p[k]);
            std::sort(q, q + 3);
            EXPECT_NEAR(q[0], 0.0, 1e-6);
            EXPECT_GT(q[1], 0.25 * spacing);
        }
        for (const auto& points : face) {
            EXPECT_EQ(points.size(), n / 6);
            EXPECT_GT(least_distance(points, 1.0), 0.5);  // infinite for one
        }
    }
    // 101 = 16 * 6 + 5: no face has two more than another.
    const VplLayout layout = place_vpls(scene, patches, {.count = 101, .samples_per_vpl = 10});
    std::vector<int> face(6);
    for (const VplSite& vpl : layout.vpls) ++face[vpl.region];
    for (const int count : face) EXPECT_TRUE(count == 16 || count == 17);
    EXPECT_EQ(layout.vpls.size(), 101u);
}

// A triangle far smaller than C has a sample only now and then; the crooked half of the wall has no
// more than the plain one.
TEST(VplLayout, GivesSmallTrianglesTheirShareOnly) {
    Scene scene = test::crooked_wall(1, 1, 60);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), {{5, 0, 0}, {6, 0, 0}, {6, 1, 0}, {5, 1, 0}});
    scene.normals.insert(scene.normals.end(), 4, glm::vec3(0, 0, 1));
    scene.triangles.push_back({{first, first + 1, first + 2}, 0});
    scene.triangles.push_back({{first, first + 2, first + 3}, 0});
    const Patches patches = make_patches(scene);
    const VplLayout layout = place_vpls(scene, patches, {.count = 40, .samples_per_vpl = 10});
    expect_consistent(scene, patches, layout);
    EXPECT_EQ(layout.region_count, 2u);
    EXPECT_EQ(std::count_if(layout.vpls.begin(), layout.vpls.end(),
                            [](const VplSite& v) { return v.region == 0; }),
              20);
    EXPECT_EQ(std::count_if(layout.samples.begin(), layout.samples.end(),
                            [](const SamplePoint& s) { return s.triangle >= 7200; }),
              200);
}

TEST(VplLayout, CoversASphere) {
    const Scene scene = furnace({.subdivisions = 5});
    const Patches patches = make_patches(scene);
    for (const std::uint32_t n : {1u, 10u, 200u, 3000u}) {
        const VplLayout layout = place_vpls(scene, patches, {.count = n, .samples_per_vpl = 10});
        expect_consistent(scene, patches, layout, n > 1000 ? 7 : 1);
        EXPECT_TRUE(layout.vpls.size() == n || (n == 1 && layout.vpls.size() <= 12));
        // The sum of A_j x_j over a sphere vanishes, and that of A_j is 4 pi, less what the
        // inscribed triangles lose.
        EXPECT_NEAR(layout.area, 12.566, 0.02);
        glm::dvec3 sum(0.0);
        for (const VplSite& vpl : layout.vpls)
            sum += double{vpl.area} * position(scene, vpl) / layout.area;
        EXPECT_LT(glm::length(sum), n == 1 ? 0.3 : n == 10 ? 0.1 : 0.01);
    }
}

// Patches by the thousand, and still the number that was asked for.
TEST(VplLayout, MergesWhatIsTooSmall) {
    const Scene scene = box();
    const Patches patches = make_patches(scene, {0.02f, 0.02f});
    ASSERT_GT(patches.patches.size(), 4000u);
    for (const std::uint32_t n : {100u, 1600u}) {
        const VplLayout usual = place_vpls(scene, patches, {.count = n, .samples_per_vpl = 10});
        expect_consistent(scene, patches, usual, 0);
        EXPECT_EQ(usual.vpls.size(), n);
        const VplLayout layout =
            place_vpls(scene, patches, {.count = n, .samples_per_vpl = 10, .gap_density = 1.0});
        expect_consistent(scene, patches, layout, 5);
        EXPECT_EQ(layout.vpls.size(), n);
        // Walls, 32 of some 34.5 m^2, give up a quarter of all VPLs at most.
        std::uint32_t on_walls = 0;
        for (const VplSite& vpl : layout.vpls) on_walls += test::area_of(scene, vpl.triangle) > 1.0;
        EXPECT_GT(on_walls, n * 32 / 34.6 - 0.25 * n - 6);  // rounding of six walls
    }
    const VplLayout one = place_vpls(scene, patches, {.count = 1, .samples_per_vpl = 10});
    expect_consistent(scene, patches, one);
    EXPECT_LE(one.vpls.size(), 6u);
}

// What nothing connects is clustered, by place and direction.
TEST(VplLayout, ClustersSpecks) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 5.0);
    test::Random random(23);
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 at(random(-5, 5), random(1, 5), random(-5, 5));
        const auto offset = [&] {
            return at + 0.02 * glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1));
        };
        test::add_triangle(scene, offset(), offset(), offset());
    }
    const Patches patches = make_patches(scene);
    ASSERT_EQ(patches.patches.size(), 3001u);
    for (const std::uint32_t n : {100u, 1000u}) {
        const VplLayout layout = place_vpls(scene, patches, {.count = n, .samples_per_vpl = 10});
        expect_consistent(scene, patches, layout);
        EXPECT_EQ(layout.vpls.size(), n);
        const auto on_floor = std::count_if(layout.vpls.begin(), layout.vpls.end(),
                                            [](const VplSite& v) { return v.triangle < 2; });
        EXPECT_GE(on_floor, 0.74 * n);
        EXPECT_LT(on_floor, n);
    }
    EXPECT_LE(place_vpls(scene, patches, {.count = 1, .samples_per_vpl = 10}).vpls.size(), 6u);
    // Nothing but islands.
    scene.triangles.erase(scene.triangles.begin(), scene.triangles.begin() + 2);
    const Patches alone = make_patches(scene);
    const VplLayout layout = place_vpls(scene, alone, {.count = 200, .samples_per_vpl = 10});
    expect_consistent(scene, alone, layout);
    EXPECT_EQ(layout.vpls.size(), 200u);
}

TEST(VplLayout, MirrorsDoubleSidedRegions) {
    Scene scene = test::crooked_wall(2, 1, 5);
    scene.materials[0].double_sided = true;
    const Patches patches = make_patches(scene);
    const VplLayout layout = place_vpls(scene, patches, {.count = 41, .samples_per_vpl = 10});
    expect_consistent(scene, patches, layout);
    EXPECT_NEAR(layout.area, 4.0, 1e-12);
    ASSERT_EQ(layout.vpls.size(), 40u);
    ASSERT_EQ(layout.samples.size() % 2, 0u);
    for (std::size_t v = 0; v < layout.vpls.size(); v += 2) {
        const VplSite &front = layout.vpls[v], &back = layout.vpls[v + 1];
        EXPECT_FALSE(front.back);
        EXPECT_TRUE(back.back);
        EXPECT_EQ(position(scene, front), position(scene, back));
        EXPECT_EQ(front.area, back.area);
        ASSERT_EQ(front.sample_count, back.sample_count);
        for (std::uint32_t i = 0; i < front.sample_count; ++i)
            EXPECT_EQ(position(scene, layout.samples[front.first_sample + i]),
                      position(scene, layout.samples[back.first_sample + i]));
    }
}

TEST(VplLayout, ApproximatesAreasByNumbersOfSamples) {
    const Scene scene = corridor();
    const Patches patches = make_patches(scene);
    const VplLayout layout =
        place_vpls(scene, patches, {.samples_per_vpl = 10, .gap_density = 1.0});
    expect_consistent(scene, patches, layout);
    EXPECT_EQ(layout.vpls.size(), 1600u);
    std::vector<double> area(layout.region_count), samples(layout.region_count);
    for (std::size_t p = 0; p < patches.patches.size(); ++p)
        area[layout.patch_region[p]] += patches.patches[p].area;
    for (const VplSite& vpl : layout.vpls) samples[vpl.region] += vpl.sample_count;
    const double c = layout.area / 16000;  // what was wanted
    for (std::uint32_t r = 0; r < layout.region_count; ++r)
        EXPECT_LE(std::abs(samples[r] * c - area[r]), 0.5 * c * (1 + 1e-9));
    EXPECT_NEAR(layout.sample_area, c, 0.01 * c);
}

TEST(VplLayout, TakesManyVplsAndSamplesOfOne) {
    const Scene scene = cornell();
    const Patches patches = make_patches(scene);
    const VplLayout layout = place_vpls(scene, patches, {.count = 25600, .samples_per_vpl = 10});
    expect_consistent(scene, patches, layout, 997);
    EXPECT_EQ(layout.vpls.size(), 25600u);
    const VplLayout single = place_vpls(scene, patches, {.count = 300, .samples_per_vpl = 1});
    expect_consistent(scene, patches, single);
    EXPECT_EQ(single.vpls.size(), 300u);
    const VplLayout dense = place_vpls(scene, patches, {.density = 50.0, .samples_per_vpl = 10});
    expect_consistent(scene, patches, dense);
    EXPECT_EQ(dense.vpls.size(), std::lround(50.0 * patches.area));
}

TEST(VplLayout, OfLittleIsLittle) {
    Scene scene = test::plain_scene();
    const VplLayout none = place_vpls(scene, make_patches(scene));
    EXPECT_TRUE(none.vpls.empty() && none.samples.empty());
    EXPECT_EQ(none.area, 0.0);
    test::add_triangle(scene, {0, 0, 0}, {3, 0, 0}, {0, 3, 0});
    const Patches patches = make_patches(scene);
    const VplLayout one = place_vpls(scene, patches, {.count = 1, .samples_per_vpl = 10});
    expect_consistent(scene, patches, one);
    ASSERT_EQ(one.vpls.size(), 1u);
    EXPECT_EQ(one.samples.size(), 10u);
    EXPECT_FLOAT_EQ(one.vpls[0].area, 4.5f);
    EXPECT_LT(glm::length(position(scene, one.vpls[0]) - glm::dvec3(1, 1, 0)), 0.5);
    expect_consistent(scene, patches,
                      place_vpls(scene, patches, {.count = 1000, .samples_per_vpl = 10}));
}

TEST(VplLayout, OutlivesSliversNeedlesAndDistance) {
    Scene scene = test::plain_scene();
    test::Random random(29);
    const auto point = [&](double size) {
        return glm::dvec3(random(-size, size), random(-size, size), random(-size, size));
    };
    for (int i = 0; i < 10000; ++i) {
        const glm::dvec3 from = point(10), along = point(3);
        const double width = std::pow(10.0, random(-9, -1));
        test::add_triangle(scene, from, from + along, from + random(0, 1) * along + point(width));
    }
    for (const double away : {0.0, 1e7}) {
        const Scene there = test::moved(scene, {away, -away, 0.5 * away});
        const Patches patches = make_patches(there);
        for (const std::uint32_t n : {50u, 2000u}) {
            for (const double dense : {1.0, 20.0, 1000.0}) {
                const VplLayout layout = place_vpls(
                    there, patches, {.count = n, .samples_per_vpl = 10, .gap_density = dense});
                EXPECT_EQ(layout.vpls.size(), n);
                if (away == 0.0) expect_consistent(there, patches, layout, dense == 1.0 ? 7 : 0);
            }
        }
    }
    // A needle 1 : 1e6 beside a floor.
    scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    test::add_triangle(scene, {-1, 1, 0}, {1, 1, 0}, {1, 1, 2e-6});
    const Patches patches = make_patches(scene);
    EXPECT_EQ(patches.skipped_triangles, 0u);
    expect_consistent(scene, patches,
                      place_vpls(scene, patches, {.count = 20, .samples_per_vpl = 10}));
}

TEST(VplLayout, IsTheSameInEveryRun) {
    const Scene scene = box();
    const VplLayout a =
        place_vpls(scene, make_patches(scene), {.count = 500, .samples_per_vpl = 10});
    const VplLayout b =
        place_vpls(scene, make_patches(scene), {.count = 500, .samples_per_vpl = 10});
    ASSERT_EQ(a.vpls.size(), b.vpls.size());
    ASSERT_EQ(a.samples.size(), b.samples.size());
    for (std::size_t v = 0; v < a.vpls.size(); ++v) {
        const VplSite &x = a.vpls[v], &y = b.vpls[v];
        EXPECT_TRUE(x.triangle == y.triangle && x.b1 == y.b1 && x.b2 == y.b2 && x.area == y.area &&
                    x.first_sample == y.first_sample && x.region == y.region);
    }
    for (std::size_t s = 0; s < a.samples.size(); ++s) {
        const SamplePoint &x = a.samples[s], &y = b.samples[s];
        EXPECT_TRUE(x.triangle == y.triangle && x.b1 == y.b1 && x.b2 == y.b2);
    }
}

TEST(VplLayout, NeedsOptionsInRange) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    const Patches patches = make_patches(scene);
    const double nan = std::nan("");
    EXPECT_THROW(place_vpls(scene, patches, {.count = 0}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.count = 11, .most = 10}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.density = -1.0}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.density = nan}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.density = 1e12}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.gap_density = 0.99}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.gap_density = 1001.0}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.gap_density = nan}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.samples_per_vpl = 0}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.samples_per_vpl = 5000}), Error);
    EXPECT_THROW(place_vpls(scene, patches, {.count = 1u << 20, .samples_per_vpl = 4096}), Error);
    test::add_floor(scene, 1.0, 1.0);
    EXPECT_THROW(place_vpls(scene, patches), Error);
}

}  // namespace
}  // namespace clgi
