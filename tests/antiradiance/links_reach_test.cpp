// What pairs of elements demand of their distance: the reach along a bin, and the least distance
// of what moves from pose to pose. And how many links there may be.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/moving_elements.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <numbers>

#include "methods/antiradiance/linking.hpp"
#include "rooms.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// Of every pair of clusters, near or far, whatever the oracle would refine: light that is let
// through goes on along the bin beyond both spheres, or not at all.
TEST(LinksReach, OfClustersIsTheSumOfTheirRadiiAlongTheBin) {
    const Scene scene = test::furnished_room(5);
    ElementOptions elements;
    elements.requested = 200;
    const ElementTree tree = make_elements(scene, elements);
    const DirectionBins bins = direction_bins(128);
    for (const Spread spread : {Spread::none, Spread::gaussian}) {
        LinkOptions options;
        options.spread = spread;
        const Linking linking(tree, bins, options, {});
        Exchange exchange = linking.exchange();
        int linked = 0, between = 0;
        std::vector<Link> out;
        for (std::uint32_t s = 0; s < tree.count(); ++s)
            for (std::uint32_t r = 0; r < tree.count(); ++r) {
                if (s == r || tree.is_leaf(s)) continue;
                const glm::dvec3 way = tree.positions[r] - tree.positions[s];
                const bool before = tree.is_flat(s) && glm::dot(tree.normals[s], way) > 0.0;
                if (before) continue;
                const double reach = tree.radii[s] + (tree.is_leaf(r) ? 0.0 : tree.radii[r]);
                out.clear();
                exchange(s, r, out);
                for (const Link& link : out) {
                    EXPECT_GT(glm::dot(way, bins.directions[link.bin]), reach)
                        << s << " to " << r << ", bin " << link.bin;
                    ++linked;
                }
                // The bin next to the way goes along at least 0.9 of it.
                between +=
                    out.empty() && 0.9 * glm::length(way) > 0.5 * reach && glm::length(way) < reach;
            }
        EXPECT_GT(linked, 1000);
        EXPECT_GT(between, 100);
    }
}

// Two small squares, of which the second moves round a corner: from (4, 0, 0) straight to
// (4, 5, 0), and from there to (0, 5, 0). From the first to the last pose it would pass as near as
// 20 / sqrt(41).
struct Corner {
    Scene scene = test::plain_scene();
    VertexPoses at;
    ElementTree tree;
    std::vector<ElementTree> poses;
    std::uint32_t still = no_index, moving = no_index;  // leaves

    explicit Corner(const std::vector<glm::dvec3>& places) {
        test::add_triangle(scene, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0.01});
        test::add_triangle(scene, {4.01, 0, 0}, {4, 0.01, 0}, {4, 0, 0.01});
        for (const glm::dvec3& place : places) {
            at.push_back(scene.positions);
            for (std::size_t v = 3; v < 6; ++v) at.back()[v] += place - glm::dvec3(4, 0, 0);
        }
        ElementOptions options;
        options.max_area = 1e6;
        options.backs = false;
        tree = make_elements(scene, options, at);
        for (const auto& pose : at) poses.push_back(posed_elements(tree, scene, pose));
        for (std::uint32_t i = 0; i < tree.count(); ++i)
            if (tree.is_leaf(i)) (tree.triangles[i] == 0 ? still : moving) = i;
    }
    // Distance by solid angle, where the height over the still square is at least the distance.
    double least_distance() const {
        const MotionRefine refine(tree, poses);
        EXPECT_TRUE(refine.moves(still, moving));
        const double radius = refine.radius(still);
        double most = 0.0;  // of the height over the distance
        const double angle = refine.seen(still, moving);
        for (const ElementTree& pose : poses)
            most =
                std::max(most, std::abs(glm::dot(pose.normals[still],
                                                 pose.positions[moving] - pose.positions[still])));
        const double area = std::min(tree.areas[still], pi * radius * radius);
        // angle = area / d^2 min(1, height / d)
        const double far = std::sqrt(area / angle);
        return most + radius >= far ? far : std::cbrt(area * (most + radius) / angle);
    }
};

TEST(MotionReach, OfWhatGoesRoundACornerIsThatOfItsPath) {
    // Both chords are 4 and 5 away at least; the chord from the first pose to the last one 3.12.
    const Corner bent({{4, 0, 0}, {4, 5, 0}, {0, 5, 0}});
    EXPECT_NEAR(bent.least_distance(), 4.0, 0.01);
    // And the path counts, not only the poses.
    const Corner straight({{4, 0, 0}, {0, 5, 0}});
    EXPECT_NEAR(straight.least_distance(), 20.0 / std::sqrt(41.0), 0.01);
    // Back and forth: chords of later poses, too.
    const Corner back({{9, 0, 0}, {9, 9, 0}, {4, 0, 0}, {0, 5, 0}, {0, 9, 0}});
    EXPECT_NEAR(back.least_distance(), 20.0 / std::sqrt(41.0), 0.01);
}

// More links than may be are refused by the thread that makes one too many.
TEST(MakeLinks, RefusesMoreThanThereMayBe) {
    const Scene scene = test::furnished_room(5);
    ElementOptions elements;
    elements.requested = 200;
    const ElementTree tree = make_elements(scene, elements);
    const DirectionBins bins = direction_bins(64);
    const std::size_t count = make_links(tree, bins).count();
    ASSERT_GT(count, 10000u);
    for (const int threads : {1, 3}) {
        LinkOptions options;
        options.threads = threads;
        EXPECT_EQ(make_links_up_to(count, tree, bins, options).count(), count);
        for (const std::size_t most : {count - 1, count / 2, std::size_t{0}}) {
            try {
                make_links_up_to(most, tree, bins, options);
                ADD_FAILURE() << "more than " << most << " links were made";
            } catch (const Error& error) {
                EXPECT_EQ(std::string(error.what()),
                          "make_links: more than " + std::to_string(most) +
                              " links; fewer elements or a larger bin_share needed");
            }
        }
    }
}

}  // namespace
}  // namespace clgi
