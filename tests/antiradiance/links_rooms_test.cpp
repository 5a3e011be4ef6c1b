// Links of whole rooms: every pair of leaves once, closed rooms of one radiance, threads.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <clgi/advanced/links.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <set>

#include "links_checks.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

Scene room(int boxes) {
    Scene scene = test::plain_scene();
    test::add_box(scene, glm::dvec3(0.0), glm::dvec3(4.0, 2.5, 5.0), -1);
    test::Random random(3);
    for (int i = 0; i < boxes; ++i) {
        const glm::dvec3 low(random(0.2, 3.0), random(0.1, 1.7), random(0.2, 4.0));
        const glm::dvec3 size(random(0.2, 0.8), random(0.2, 0.7), random(0.2, 0.8));
        test::add_box(scene, low, low + size, 1);
    }
    return scene;
}

void expect_equal(const Links& a, const Links& b) {
    EXPECT_EQ(a.first, b.first);
    EXPECT_EQ(a.senders, b.senders);
    EXPECT_EQ(a.bins, b.bins);
    EXPECT_EQ(a.form_factors, b.form_factors);
    EXPECT_EQ(a.pairs, b.pairs);
    EXPECT_EQ(a.unrefined, b.unrefined);
}

TEST(LinksOfRooms, AreSortedAndTheSameForAnyThreads) {
    const ElementTree tree = make_elements(room(8), {.requested = 600});
    const DirectionBins bins = direction_bins(128);
    const Links links = make_links(tree, bins, {.threads = 1});
    ASSERT_EQ(links.first.size(), tree.count() + 1);
    ASSERT_EQ(links.first.back(), links.count());
    for (std::size_t i = 0; i < tree.count(); ++i)
        for (std::size_t k = links.first[i] + 1; k < links.first[i + 1]; ++k)
            ASSERT_LT(std::pair(links.senders[k - 1], links.bins[k - 1]),
                      std::pair(links.senders[k], links.bins[k]));
    for (const int threads : {2, 3, 7, 0})
        expect_equal(links, make_links(tree, bins, {.threads = threads}));
    EXPECT_EQ(links.bytes(), 4 * (tree.count() + 1) + 10 * links.count());
}

// Every ordered pair of leaves has one link of elements that hold them, or the receiver does not
// see the sender's front or back: it looks away, or one of them is seen edge-on.
TEST(LinksOfRooms, CoverEveryPairOfLeavesOnce) {
    const ElementTree tree = make_elements(room(8), {.requested = 300});
    const DirectionBins bins = direction_bins(128);
    const Links links = make_links(tree, bins, {.bin_share = 1.0});
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::uint32_t i = 0; i < tree.count(); ++i)
        for (std::size_t k = links.first[i]; k < links.first[i + 1]; ++k)
            pairs.insert({i, links.senders[k]});
    EXPECT_GT(links.pairs, pairs.size() / 2 - 1);
    EXPECT_LE(pairs.size(), 2 * links.pairs);
    const double width = std::sqrt(4.0 * pi / 128);  // of a bin
    std::size_t linked = 0, culled = 0;
    for (std::uint32_t i = 0; i < tree.count(); ++i)
        for (std::uint32_t k = 0; k < tree.count(); ++k) {
            if (i == k || !tree.is_leaf(i) || !tree.is_leaf(k)) continue;
            int times = 0;
            for (std::uint32_t a = i; a != no_index; a = tree.parents[a])
                for (std::uint32_t b = k; b != no_index; b = tree.parents[b])
                    times += static_cast<int>(pairs.count({a, b}));
            ASSERT_LE(times, 1) << i << " " << k;
            if (times == 1) {
                ++linked;
                continue;
            }
            ++culled;
            const glm::dvec3 w = glm::normalize(tree.positions[k] - tree.positions[i]);
            const double front = glm::dot(w, tree.normals[i]);
            const double side = std::abs(glm::dot(w, tree.normals[k]));
            ASSERT_TRUE(front < width || side < 1e-6) << i << " " << k << " " << front;
        }
    EXPECT_GT(linked, 10000u);
    EXPECT_GT(culled, 10000u);
}

// A closed convex room of radiance 1: 2 pi of solid angle and pi of irradiance at every leaf.
TEST(LinksOfRooms, FillEveryHemisphereOfAClosedRoom) {
    const ElementTree tree = make_elements(room(0), {.requested = 1500});
    const DirectionBins bins = direction_bins(512);
    const test::Arrived fine =
        test::send_one(tree, bins, make_links(tree, bins, {.bin_share = 0.2}));
    EXPECT_LT(fine.farthest_solid_angle, 0.015);
    EXPECT_LT(fine.farthest_irradiance, 0.03);
    const test::Arrived usual = test::send_one(tree, bins, make_links(tree, bins));
    EXPECT_LT(usual.farthest_irradiance, 0.05);
    EXPECT_NEAR(usual.mean_irradiance, pi, 0.005 * pi);
    EXPECT_LT(fine.farthest_irradiance, 0.7 * usual.farthest_irradiance);
    std::printf("closed room, 512 bins: irradiance within %.4f, with a share of 0.2 %.4f\n",
                usual.farthest_irradiance, fine.farthest_irradiance);
}

// Curved, of clusters that are not flat.
TEST(LinksOfRooms, FillEveryHemisphereOfASphere) {
    const ElementTree tree = make_elements(furnace({.subdivisions = 3}), {.requested = 1280});
    ASSERT_EQ(tree.leaves, 1280u);
    const DirectionBins bins = direction_bins(512);
    const test::Arrived arrived = test::send_one(tree, bins, make_links(tree, bins));
    EXPECT_NEAR(arrived.mean_irradiance, pi, 0.02 * pi);
    EXPECT_LT(arrived.farthest_irradiance, 0.06);
}

TEST(LinksOfRooms, DoNotDependOnSizeAndPlace) {
    const Scene scene = room(3);
    Scene large = scene;
    for (glm::dvec3& p : large.positions) p = 1024.0 * p + glm::dvec3(1 << 20, -(1 << 19), 1 << 18);
    const DirectionBins bins = direction_bins(128);
    const ElementTree one = make_elements(scene, {.max_area = 0.2});
    const ElementTree other = make_elements(large, {.max_area = 0.2 * 1048576.0});
    ASSERT_EQ(one.count(), other.count());
    const Links a = make_links(one, bins), b = make_links(other, bins);
    // Rounding of positions decides for other bins and sides where it is close.
    EXPECT_NEAR(static_cast<double>(a.count()), static_cast<double>(b.count()), 0.002 * a.count());
    double sum_a = 0.0, sum_b = 0.0;
    for (const float f : a.form_factors) sum_a += f;
    for (const float f : b.form_factors) sum_b += f;
    EXPECT_NEAR(sum_a, sum_b * 1048576.0, 0.02 * sum_a);
}

TEST(LinksOfRooms, EndForNestedSpheres) {
    Scene scene = test::plain_scene();
    for (const double radius : {1.0, 0.5, 0.4999, 1e-3, 1e-6}) {
        const Scene sphere = furnace({.subdivisions = 2, .radius = radius});
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        scene.positions.insert(scene.positions.end(), sphere.positions.begin(),
                               sphere.positions.end());
        scene.normals.insert(scene.normals.end(), sphere.normals.begin(), sphere.normals.end());
        for (SceneTriangle t : sphere.triangles) {
            for (std::uint32_t& v : t.vertex) v += first;
            t.material = 0;
            scene.triangles.push_back(t);
        }
    }
    const ElementTree tree = make_elements(scene);
    const Links links = make_links(tree, direction_bins(128));
    EXPECT_GT(links.count(), 1000u);
    for (const float f : links.form_factors) ASSERT_TRUE(std::isfinite(f) && f > 0.0f);
}

// The size of the paper's office (table 1): 18,253 elements, 632,098 links, 128 bins; 8.7 s.
TEST(LinksOfRooms, OfAnOfficeAreAsManyAsThePapers) {
    const ElementTree tree = make_elements(room(12), {.requested = 13700});
    const auto start = std::chrono::steady_clock::now();
    const Links links = make_links(tree, direction_bins(128));
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    std::printf("office: %zu elements, %zu pairs, %zu links, %zu unrefined, %.1f MB, %.2f s\n",
                tree.count(), links.pairs, links.count(), links.unrefined,
                static_cast<double>(links.bytes()) * 1e-6, time.count());
    EXPECT_NEAR(static_cast<double>(tree.count()), 18253.0, 2000.0);
    EXPECT_LT(links.pairs, 2u * 632098u);
    EXPECT_LT(links.bytes(), 29500000u);  // table 2
}

}  // namespace
}  // namespace clgi
