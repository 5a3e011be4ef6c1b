// Links of geometry that moves: made once for all poses.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/shared/moving_elements.h>
#include <algorithm>
#include <clgi/advanced/links.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "moving_room.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

struct Linked {
    ElementTree tree;
    std::vector<ElementTree> poses;
    DirectionBins bins = direction_bins(128);
    LinkOptions options;
    Links links;

    Linked(const Scene& scene, const VertexPoses& at, std::size_t leaves) {
        ElementOptions elements;
        elements.requested = leaves;
        tree = make_elements(scene, elements, at);
        for (const auto& pose : at) poses.push_back(posed_elements(tree, scene, pose));
        links = make_links(tree, bins, options, poses);
    }
    double limit() const { return options.bin_share * 4.0 * pi / bins.count(); }
};

TEST(MovingLinks, AreThoseOfTheStillSceneWhereNothingMoves) {
    const Scene scene = test::furnished_room(5);
    const Linked moving(scene, {scene.positions, scene.positions}, 400);
    const Links wanted = make_links(moving.tree, moving.bins, {});
    EXPECT_TRUE(moving.links.moving.empty());
    EXPECT_EQ(moving.links.first, wanted.first);
    EXPECT_EQ(moving.links.senders, wanted.senders);
    EXPECT_EQ(moving.links.bins, wanted.bins);
    EXPECT_EQ(moving.links.form_factors, wanted.form_factors);
}

// Two leaves of which one moves have one pair of elements that hold them, in each direction in
// which some pose shows the sender to the receiver; and never more than one.
TEST(MovingLinks, JoinAllThatFaceEachOtherInSomePose) {
    const test::MovingRoom room;
    const Linked of(room.scene, room.poses(4), 150);
    const ElementTree& tree = of.tree;
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;  // receiver, sender
    for (std::uint32_t r = 0; r < tree.count(); ++r)
        for (std::uint32_t k = of.links.first[r]; k < of.links.first[r + 1]; ++k)
            pairs.insert({r, of.links.senders[k]});
    std::size_t facing = 0, hidden = 0;
    for (std::uint32_t r = 0; r < tree.count(); ++r)
        for (std::uint32_t s = 0; s < tree.count(); ++s) {
            if (!tree.is_leaf(r) || !tree.is_leaf(s) || r == s) continue;
            if (!tree.moves(r) && !tree.moves(s)) continue;
            int found = 0;
            for (std::uint32_t a = r; a != no_index; a = tree.parents[a])
                for (std::uint32_t b = s; b != no_index; b = tree.parents[b])
                    found += pairs.count({a, b}) > 0;
            EXPECT_LE(found, 1) << r << " from " << s;
            bool shown = false;
            for (const ElementTree& pose : of.poses)
                for (const glm::dvec3& corner : pose.corners[s])
                    shown |= glm::dot(pose.normals[r], corner - pose.positions[r]) > 1e-4;
            if (shown) {
                EXPECT_EQ(found, 1) << r << " from " << s;
            }
            ++(shown ? facing : hidden);
        }
    EXPECT_GT(facing, 1000u);
    EXPECT_GT(hidden, 1000u);
}

// A slab that flies over a floor and is nearest to its middle between the two poses that were
// given: no element that is not a leaf is larger than it may be, wherever the slab is.
TEST(MovingLinks, AreFineEnoughBetweenPoses) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 2.0);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    test::add_box(scene, {-3.4, 0.3, -0.2}, {-3.0, 0.4, 0.2}, 1);
    const auto at = [&](double time) {
        std::vector<glm::dvec3> out = scene.positions;
        for (std::uint32_t v = first; v < out.size(); ++v) out[v].x += 6.4 * time;
        return out;
    };
    const Linked of(scene, {at(0.0), at(1.0)}, 2000);
    ASSERT_GT(of.links.moving.size(), 1000u);
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const LinkOfMotion& link : of.links.moving)
        pairs.insert({link.receiver, of.links.senders[link.link]});
    std::size_t inner = 0;
    for (int k = 0; k <= 20; ++k) {
        const ElementTree pose = posed_elements(of.tree, scene, at(k / 20.0));
        for (const auto& [r, s] : pairs) {
            const double distance = glm::distance(pose.positions[r], pose.positions[s]);
            for (const std::uint32_t i : {r, s}) {
                if (pose.is_leaf(i)) continue;
                const double radius = pose.radii[i];
                const double seen =
                    std::min(pose.areas[i], pi * radius * radius) / (distance * distance);
                const double tilt =
                    pose.is_patch(i)
                        ? std::min(1.0, (std::abs(glm::dot(pose.normals[i],
                                                           pose.positions[r] - pose.positions[s])) +
                                         pose.radii[i == r ? s : r]) /
                                            distance)
                        : 1.0;
                EXPECT_LE(seen * tilt, of.limit() * (1.0 + 1e-9));
                ++inner;
            }
        }
    }
    EXPECT_GT(inner, 100u);
}

// A pair has a link for each part of its sender: one, four or sixteen, as its largest solid angle
// wants it.
TEST(MovingLinks, HaveOneForEachPartOfALargeSender) {
    const test::MovingRoom room;
    const Linked of(room.scene, room.poses(4), 400);
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> parts;
    for (std::size_t k = 0; k < of.links.moving.size(); ++k) {
        const LinkOfMotion& link = of.links.moving[k];
        EXPECT_GE(link.link, of.links.first[link.receiver]);
        EXPECT_LT(link.link, of.links.first[link.receiver + 1]);
        if (k > 0) {
            EXPECT_LT(of.links.moving[k - 1].link, link.link);
        }
        const std::uint32_t sender = of.links.senders[link.link];
        EXPECT_TRUE(of.tree.moves(link.receiver) || of.tree.moves(sender));
        parts[{link.receiver, sender}].push_back(link.part);
    }
    std::map<std::size_t, std::size_t> counts;
    for (const auto& [pair, found] : parts) {
        const std::uint32_t first = found.size() == 1   ? PART_WHOLE
                                    : found.size() == 4 ? PART_QUARTERS
                                                        : PART_SIXTEENTHS;
        for (std::size_t k = 0; k < found.size(); ++k) ASSERT_EQ(found[k], first + k);
        double largest = 0.0;
        for (const ElementTree& pose : of.poses) {
            const glm::dvec3 way = pose.positions[pair.first] - pose.positions[pair.second];
            const double square = glm::dot(way, way);
            if (square > 0.0 && pose.is_patch(pair.second))
                largest = std::max(largest, pose.areas[pair.second] / square *
                                                std::abs(glm::dot(pose.normals[pair.second], way)) /
                                                std::sqrt(square));
        }
        // Far away a small patch has about area * cosine / distance^2.
        if (largest < 0.5 * of.limit() && found.size() > 1) {
            EXPECT_GT(largest, 0.1 * of.limit());
        }
        if (found.size() == 1) {
            EXPECT_LT(largest, 2.0 * of.limit());
        }
        if (found.size() == 4) {
            EXPECT_LT(largest, 8.0 * of.limit());
        }
        ++counts[found.size()];
    }
    EXPECT_EQ(counts.size(), 3u);
    for (const std::size_t size : {1, 4, 16}) EXPECT_GT(counts[size], 100u) << size;
}

TEST(MovingLinks, AreTheSameForAnyNumberOfThreads) {
    const test::MovingRoom room;
    const Linked of(room.scene, room.poses(4), 300);
    for (const int threads : {1, 3}) {
        LinkOptions options;
        options.threads = threads;
        const Links found = make_links(of.tree, of.bins, options, of.poses);
        EXPECT_EQ(found.senders, of.links.senders);
        EXPECT_EQ(found.bins, of.links.bins);
        EXPECT_EQ(found.form_factors, of.links.form_factors);
        ASSERT_EQ(found.moving.size(), of.links.moving.size());
        for (std::size_t k = 0; k < found.moving.size(); ++k)
            EXPECT_EQ(found.moving[k].part, of.links.moving[k].part);
    }
}

TEST(MovingLinks, RefusePosesOfAnotherTree) {
    const test::MovingRoom room;
    const Linked of(room.scene, room.poses(2), 100);
    const ElementTree other = make_elements(test::furnished_room(1));
    EXPECT_THROW(make_links(of.tree, of.bins, {}, {other}), Error);
}

}  // namespace
}  // namespace clgi
