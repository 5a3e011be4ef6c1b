// What patches are merged with, and how VPLs are shared out among what comes of it.
// SPDX-License-Identifier: MIT
#include "methods/light_atlas/regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/procedural.hpp>
#include <cmath>
#include <set>

#include "methods/light_atlas/clusters_of_islands.hpp"
#include "scenes.hpp"
#include "walls.hpp"

namespace clgi {
namespace {

std::int64_t vpls_of(const std::vector<Region>& regions) {
    std::int64_t sum = 0;
    for (const Region& region : regions)
        sum += std::int64_t{region.vpls} * (region.double_sided ? 2 : 1);
    return sum;
}

// The largest angle between the mean normal of a region and that of one of its patches, radians.
double widest_angle(const Patches& patches, const std::vector<Region>& regions) {
    double cosine = 1.0;
    for (const Region& region : regions)
        for (const std::uint32_t p : region.patches)
            cosine = std::min(cosine, glm::dot(patches.patches[p].normal, region.normal));
    return std::acos(cosine);
}

void expect_partition(const Patches& patches, const std::vector<Region>& regions) {
    std::vector<int> seen(patches.patches.size());
    for (const Region& region : regions) {
        double area = 0.0;
        for (const std::uint32_t p : region.patches) {
            ++seen[p];
            area += patches.patches[p].area;
            EXPECT_EQ(patches.patches[p].double_sided, region.double_sided);
        }
        EXPECT_NEAR(region.area, area, 1e-9 * area);
        EXPECT_NEAR(glm::length(region.normal), 1.0, 1e-9);
        EXPECT_GE(region.vpls, 1u);
    }
    for (const int times : seen) EXPECT_EQ(times, 1);
}

// Three faces of a cube are within 54.8 degrees of their mean; no hemisphere holds more.
TEST(Regions, OfACubeAreFacesOrHalves) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {0, 0, 0}, {1, 1, 1}, 1);
    const Patches patches = make_patches(scene);
    for (const std::uint32_t count : {6u, 7u, 60u}) {
        const std::vector<Region> regions = make_regions(patches, count);
        expect_partition(patches, regions);
        EXPECT_EQ(regions.size(), 6u);
        EXPECT_EQ(vpls_of(regions), count);
    }
    const std::vector<Region> halves = make_regions(patches, 1);
    expect_partition(patches, halves);
    ASSERT_EQ(halves.size(), 2u);
    for (const Region& half : halves) EXPECT_EQ(half.patches.size(), 3u);
    EXPECT_LT(widest_angle(patches, halves), 0.96);
}

TEST(Regions, StayWithinTheirCones) {
    const Scene scene = furnace({.subdivisions = 5});
    const Patches patches = make_patches(scene, {0.05f, 1.0f});
    ASSERT_GT(patches.patches.size(), 1000u);
    const double pi = 3.14159265358979323846;
    const std::vector<Region> many = make_regions(patches, 300);
    expect_partition(patches, many);
    EXPECT_EQ(vpls_of(many), 300);
    EXPECT_LT(widest_angle(patches, many), 0.25 * pi);
    for (const Region& region : many) EXPECT_GE(region.area, 0.5 * patches.area / 300);
    const std::vector<Region> few = make_regions(patches, 8);
    expect_partition(patches, few);
    EXPECT_EQ(vpls_of(few), 8);
    EXPECT_LT(widest_angle(patches, few), 0.5 * pi);
}

// A strip between a wall and another one, 27 degrees from the first and 63 from the second.
TEST(Regions, JoinTheNeighbourThatFacesAsTheyDo) {
    Scene scene = test::plain_scene();
    const double tilt = 0.05;  // the strip rises by this much over its width, 0.1
    test::add_quad(scene, {glm::dvec3(0, 0, 0), {4, 0, 0}, {4, 4, 0}, {0, 4, 0}});
    test::add_quad(scene, {glm::dvec3(4, 0, 0), {4.1, 0, tilt}, {4.1, 4, tilt}, {4, 4, 0}});
    test::add_quad(scene, {glm::dvec3(4.1, 0, tilt), {4.1, 0, 3}, {4.1, 4, 3}, {4.1, 4, tilt}});
    const Patches patches = make_patches(scene, {0.3f, 0.001f});
    ASSERT_EQ(patches.patches.size(), 3u);
    const std::uint32_t wall = patches.triangle_patch[0], strip = patches.triangle_patch[2];
    const std::vector<Region> regions = make_regions(patches, 10);
    expect_partition(patches, regions);
    ASSERT_EQ(regions.size(), 2u);
    const auto both = std::max_element(
        regions.begin(), regions.end(),
        [](const Region& a, const Region& b) { return a.patches.size() < b.patches.size(); });
    EXPECT_EQ(both->patches,
              (std::vector<std::uint32_t>{std::min(wall, strip), std::max(wall, strip)}));
    EXPECT_EQ(make_regions(patches, 2000).size(), 3u);
}

TEST(Regions, ExceedTheCountByDirectionsOnly) {
    Scene scene = test::plain_scene();
    for (int i = 0; i < 50; ++i) {
        const double x = 3.0 * i;
        test::add_quad(scene, {glm::dvec3(x, 0, 0), {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
    }
    test::Random random(31);
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 at(random(0, 150), random(2, 4), random(-1, 1));
        const auto offset = [&] {
            return at + 0.01 * glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1));
        };
        test::add_triangle(scene, offset(), offset(), offset());
    }
    const Patches patches = make_patches(scene);
    const std::vector<Region> regions = make_regions(patches, 50);
    expect_partition(patches, regions);
    EXPECT_GE(vpls_of(regions), 50);
    EXPECT_LE(vpls_of(regions), 56);
    EXPECT_EQ(vpls_of(make_regions(patches, 80)), 80);
}

TEST(Islands, AreCutAcrossTheirLongestSide) {
    std::vector<Island> islands;
    for (int axis = 0; axis < 3; ++axis) {
        islands.clear();
        for (std::uint32_t i = 0; i < 64; ++i) {
            glm::dvec3 at(0.1 * (i % 2), 0.1 * (i / 2 % 2), 0.1 * (i % 2));
            at[axis] = i;
            islands.push_back({i, 1.0, at, {0, 0, 1}, false});
        }
        const auto clusters = cluster_islands(islands, 8);
        ASSERT_EQ(clusters.size(), 8u);
        for (const auto& cluster : clusters) {
            ASSERT_EQ(cluster.size(), 8u);
            const auto [low, high] = std::minmax_element(cluster.begin(), cluster.end());
            EXPECT_EQ(*high - *low, 7u);
        }
    }
}

TEST(Islands, OfOneClusterFaceOneWayAndHaveOneKind) {
    std::vector<Island> islands;
    for (std::uint32_t i = 0; i < 48; ++i) {
        glm::dvec3 normal(0.3, -0.2, 0.1);
        normal[i % 3] = i % 2 == 0 ? 1.0 : -1.0;
        islands.push_back({i, 1.0 + i, glm::dvec3(i * i % 17, i % 5, i), normal, i % 4 >= 2});
    }
    for (const std::int64_t room : {0, 1, 30}) {
        std::int64_t sites = 0;
        std::set<std::uint32_t> seen;
        for (const auto& cluster : cluster_islands(islands, room)) {
            sites += islands[cluster[0]].double_sided ? 2 : 1;
            for (const std::uint32_t i : cluster) {
                seen.insert(i);
                EXPECT_EQ(i % 3, cluster[0] % 3);
                EXPECT_EQ(i % 2, cluster[0] % 2);
                EXPECT_EQ(islands[i].double_sided, islands[cluster[0]].double_sided);
            }
        }
        EXPECT_EQ(seen.size(), 48u);
        EXPECT_EQ(sites, room == 30 ? 30 : 18);
    }
}

}  // namespace
}  // namespace clgi
