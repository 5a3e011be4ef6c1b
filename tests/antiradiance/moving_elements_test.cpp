// Elements of geometry that moves, on the host: their tree, and where poses put them.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/animation.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>
#include "lab/scenes/deforming.hpp"

#include "moving_room.hpp"

namespace clgi {
namespace {

ElementOptions leaves(std::size_t requested) {
    ElementOptions out;
    out.requested = requested;
    return out;
}

TEST(MovingElements, AreNoneInSceneThatStandsStill) {
    const test::MovingRoom room;
    const ElementTree wanted = make_elements(room.scene, leaves(900));
    const ElementTree found =
        make_elements(room.scene, leaves(900), {room.scene.positions, room.scene.positions});
    EXPECT_TRUE(found.moving.empty());
    EXPECT_EQ(found.positions, wanted.positions);
    EXPECT_EQ(found.normals, wanted.normals);
    EXPECT_EQ(found.ends, wanted.ends);
    const ElementTree at = posed_elements(found, room.scene, room.at(0.7));
    EXPECT_EQ(at.positions, wanted.positions);
}

// Of clusters only those right below the root, one of fronts and one of backs, and the root hold
// both what moves and what does not.
TEST(MovingElements, AreApartFromThoseThatStandStill) {
    const test::MovingRoom room;
    const ElementTree tree = make_elements(room.scene, leaves(900), room.poses(3));
    const auto goes = [&](std::uint32_t triangle) {
        bool out = false;
        for (const std::uint32_t v : room.scene.triangles[triangle].vertex)
            for (const auto& pose : room.poses(3))
                out |= glm::distance(pose[v], room.scene.positions[v]) > 1e-3;
        return out;
    };
    std::size_t moving = 0;
    for (std::size_t i = 0; i < tree.count(); ++i) {
        bool any = false, all = true;
        for (std::size_t k = i; k < tree.ends[i]; ++k) {
            if (!tree.is_leaf(k)) continue;
            const bool moves = goes(tree.triangles[k]);
            any |= moves;
            all &= moves;
        }
        EXPECT_EQ(tree.moves(i), any) << i;
        if (any && !all) {
            EXPECT_LE(tree.levels[i], 1u) << i;
        }
        if (any && !tree.is_patch(i)) {
            EXPECT_FALSE(tree.is_flat(i)) << i;
        }
        moving += tree.is_leaf(i) && any;
    }
    EXPECT_GT(moving, 50u);
}

// Boxes that lie within each other at first: the tree tells them apart by where they go.
TEST(MovingElements, AreApartFromThoseThatGoElsewhere) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 3.0);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (int k = 0; k < 2; ++k) test::add_box(scene, {0.0, 1.0 + 0.01 * k, 0}, {1, 2, 1}, 1);
    const std::uint32_t second =
        first + (static_cast<std::uint32_t>(scene.positions.size()) - first) / 2;
    VertexPoses poses(2, scene.positions);
    for (std::uint32_t v = first; v < scene.positions.size(); ++v)
        poses[1][v].z += v < second ? -2.0 : 2.0;
    const ElementTree tree = make_elements(scene, leaves(100), poses);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.moves(i) || tree.is_patch(i) || tree.levels[i] < 3) continue;
        bool one = false, other = false;
        for (std::size_t k = i; k < tree.ends[i]; ++k)
            if (tree.is_leaf(k))
                (scene.triangles[tree.triangles[k]].vertex[0] < second ? one : other) = true;
        EXPECT_FALSE(one && other) << i;
    }
}

// A motion that is rigid takes every element with it.
TEST(PosedElements, GoWithAMotionThatIsRigid) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {0, 0, 0}, {1, 0.7, 0.4}, 1);
    test::add_triangle(scene, {2, 0, 0}, {2, 1, 0.3}, {3, 0, 0.1});  // open: it has a back
    const glm::dmat4 motion = glm::rotate(glm::translate(glm::dmat4(1.0), glm::dvec3(3, -1, 2)),
                                          0.8, glm::normalize(glm::dvec3(1, 2, 3)));
    const auto moved = [&](const glm::dvec3& p) { return glm::dvec3(motion * glm::dvec4(p, 1.0)); };
    std::vector<glm::dvec3> pose;
    for (const glm::dvec3& p : scene.positions) pose.push_back(moved(p));
    const ElementTree tree = make_elements(scene, leaves(150), {pose});
    const ElementTree at = posed_elements(tree, scene, pose);
    ASSERT_GT(tree.count(), 150u);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        EXPECT_LT(glm::distance(at.positions[i], moved(tree.positions[i])), 1e-12) << i;
        EXPECT_NEAR(at.areas[i], tree.areas[i], 1e-12) << i;
        EXPECT_NEAR(at.radii[i], tree.radii[i], 1e-12) << i;
        EXPECT_LT(glm::distance(at.normals[i], glm::dmat3(motion) * tree.normals[i]), 1e-12) << i;
    }
}

TEST(PosedElements, HoldWhatDeforms) {
    const test::MovingRoom room;
    const ElementTree tree = make_elements(room.scene, leaves(900), room.poses(3));
    const Scene there = room.posed(0.3);
    const ElementTree at = posed_elements(tree, room.scene, there.positions);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        double area = 0.0, reach = 0.0;
        glm::dvec3 middle(0.0);
        for (std::size_t k = i; k < tree.ends[i]; ++k) {
            if (!tree.is_leaf(k)) continue;
            area += at.areas[k];
            middle += at.areas[k] * at.positions[k];
            for (const glm::dvec3& corner : at.corners[k])
                reach = std::max(reach, glm::distance(corner, at.positions[i]));
        }
        EXPECT_NEAR(at.areas[i], area, 1e-9);
        EXPECT_LT(glm::distance(at.positions[i], middle / area), 1e-9);
        EXPECT_NEAR(at.radii[i], reach, 1e-9);
        if (!tree.is_patch(i)) continue;
        const auto& c = at.corners[i];
        const glm::dvec3 across = glm::cross(c[1] - c[0], c[2] - c[0]);
        EXPECT_LT(glm::distance(glm::normalize(across), at.normals[i]), 1e-9);
        EXPECT_NEAR(0.5 * glm::length(across), at.areas[i], 1e-9);
    }
}

// Triangles that shrink to a line or a point have neither area nor normal, and nothing is NaN.
TEST(PosedElements, StayFiniteWhereTrianglesCollapse) {
    const test::MovingRoom room;
    const ElementTree tree = make_elements(room.scene, leaves(900), room.poses(3));
    for (const int kind : {0, 1}) {
        std::vector<glm::dvec3> pose = room.at(0.3);
        for (std::uint32_t v = room.first; v < pose.size(); ++v)
            pose[v] = kind == 0 ? glm::dvec3(1.0, 1.0, 1.0) : glm::dvec3(0.1 * v, 1.0, 1.0);
        const ElementTree at = posed_elements(tree, room.scene, pose);
        for (std::size_t i = 0; i < tree.count(); ++i) {
            EXPECT_TRUE(std::isfinite(at.positions[i].x + at.radii[i] + at.areas[i]));
            if (!tree.moves(i) || !tree.is_patch(i)) continue;
            EXPECT_EQ(at.normals[i], glm::dvec3(0.0));
            EXPECT_EQ(at.areas[i], 0.0);
        }
    }
}

TEST(VertexPoses, AreThoseOfTheClip) {
    const Scene scene = chess();
    const VertexPoses poses = vertex_poses(scene, 0, 5);
    ASSERT_EQ(poses.size(), 5u);
    const double duration = scene.animation->clips[0].duration;
    for (int k = 0; k < 5; ++k)
        EXPECT_EQ(poses[k],
                  posed(scene, pose_at(*scene.animation, 0, duration * k / 4.0)).positions);
    EXPECT_EQ(vertex_poses(scene, 0, 1)[0], poses[0]);
    EXPECT_THROW(vertex_poses(scene, 0, 0), Error);
    EXPECT_THROW(vertex_poses(scene, 0, 1001), Error);
    EXPECT_THROW(vertex_poses(scene, 1, 4), Error);
    EXPECT_THROW(vertex_poses(cornell(), 0, 4), Error);
}

TEST(MovingElements, RefusePosesThatDoNotFit) {
    const test::MovingRoom room;
    VertexPoses poses = room.poses(2);
    poses[1].pop_back();
    EXPECT_THROW(make_elements(room.scene, leaves(100), poses), Error);
    poses = room.poses(2);
    poses[1][3].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(make_elements(room.scene, leaves(100), poses), InputError);
    const ElementTree tree = make_elements(room.scene, leaves(100), room.poses(2));
    EXPECT_THROW(posed_elements(tree, room.scene, {}), Error);
}

}  // namespace
}  // namespace clgi
