// The tree of boxes over clusters: every cluster is in it once, boxes are the least, walks keep
// short lists, and the device gives boxes anew.
// SPDX-License-Identifier: MIT
#include "scene/box_tree.hpp"

#include <gtest/gtest.h>
#include <clgi/error.hpp>
#include <clgi/passes/scene.hpp>
#include <clgi/procedural.hpp>
#include <cmath>

#include "box_trees.hpp"
#include "lab/scenes/rooms.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

Cluster cluster_at(const glm::vec3& low, const glm::vec3& high) {
    Cluster out{};
    out.low = glm::vec4(low, 0.0f);
    out.high = glm::vec4(high, 0.0f);
    return out;
}

std::vector<Cluster> random_clusters(int count, std::uint64_t seed) {
    test::Random random(seed);
    std::vector<Cluster> out;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 at(random(-1, 1), random(-1, 1), random(-1, 1));
        out.push_back(
            cluster_at(at, at + glm::vec3(random(0, 0.2), random(0, 0.2), random(0, 0.2))));
    }
    return out;
}

// Each half as large as the one before, from a corner on: by areas one at a time is cut off.
std::vector<Cluster> spiral(int count) {
    std::vector<Cluster> out;
    for (int i = 0; i < count; ++i) {
        const float size = std::exp2(-0.02f * static_cast<float>(i));
        out.push_back(cluster_at(glm::vec3(0.5f * size), glm::vec3(size)));
    }
    return out;
}

// The longest list of what is put off, if a walk meets every box.
std::size_t put_off(const std::vector<BoxNode>& nodes) {
    std::vector<std::uint32_t> open{0};
    std::size_t most = 1;
    while (!open.empty()) {
        const std::uint32_t at = open.back();
        open.pop_back();
        if (at & NODE_CLUSTER) continue;
        for (const std::uint32_t child : nodes[at].child)
            if (child != NODE_NONE) open.push_back(child);
        most = std::max(most, open.size());
    }
    return most;
}

TEST(BoxTree, HoldsEveryClusterOnceInTheLeastBoxes) {
    for (const int count : {1, 2, 15, 16, 17, 255, 257, 3000}) {
        const std::vector<Cluster> clusters = random_clusters(count, 40 + count);
        const BoxTree tree = make_box_tree(clusters);
        test::expect_boxes(tree.nodes, clusters, std::to_string(count));
        EXPECT_EQ(tree.levels.front(), 0u);
        EXPECT_EQ(tree.levels.back(), tree.nodes.size());
        EXPECT_GE(16.0, static_cast<double>(count) / static_cast<double>(tree.nodes.size()));
        // What nodes of a level have lies in the next one.
        for (std::size_t level = 0; level + 1 < tree.levels.size(); ++level)
            for (std::uint32_t i = tree.levels[level]; i < tree.levels[level + 1]; ++i)
                for (const std::uint32_t child : tree.nodes[i].child) {
                    if (child == NODE_NONE || child & NODE_CLUSTER) continue;
                    ASSERT_LT(level + 2, tree.levels.size());
                    EXPECT_GE(child, tree.levels[level + 1]);
                    EXPECT_LT(child, tree.levels[level + 2]);
                }
    }
}

TEST(BoxTree, OfNothingHasNoNodes) {
    const BoxTree tree = make_box_tree({});
    EXPECT_TRUE(tree.nodes.empty());
    EXPECT_EQ(tree.levels, std::vector<std::uint32_t>{0});
}

// 20 clusters beside one another, and 3 far away, which come first: cut in halves, a box would hold
// some of both.
TEST(BoxTree, IsCutWhereNothingIs) {
    std::vector<Cluster> clusters;
    for (int i = 0; i < 23; ++i) {
        const float x =
            i < 3 ? 0.01f * static_cast<float>(i) - 100.0f : 5.0f + static_cast<float>(i % 5);
        const float y = i < 3 ? 0.0f : static_cast<float>(i / 5);
        clusters.push_back(cluster_at({x, y, 0}, {x + 0.005f, y + 0.9f, 1}));
    }
    for (const bool turned : {false, true}) {
        if (turned) std::reverse(clusters.begin(), clusters.end());
        for (const BoxNode& node : make_box_tree(clusters).nodes)
            for (int k = 0; k < NODE_BOXES; ++k)
                if (node.child[k] != NODE_NONE) {
                    EXPECT_FALSE(node.low[0][k] < 0.0f && node.high[0][k] > 4.0f) << k;
                }
    }
}

// The root of a tree over small clusters side by side, and as far on as there are, large ones.
BoxNode root_of(int small, int large) {
    std::vector<Cluster> clusters;
    for (int i = 0; i < small + large; ++i) {
        const bool is_small = i < small;
        const float x = is_small ? 1e-3f * static_cast<float>(i) : static_cast<float>(i);
        clusters.push_back(cluster_at(
            {x, 0, 0}, is_small ? glm::vec3(x + 5e-4f, 1e-3f, 1e-3f) : glm::vec3(x + 0.9f, 1, 1)));
    }
    return make_box_tree(clusters).nodes[0];
}

// The root takes the largest boxes apart first: of as many large clusters as small ones, the large.
TEST(BoxTree, TakesLargeBoxesApartFirst) {
    const BoxNode root = root_of(180, 180);
    int small = 0, large = 0;
    for (int k = 0; k < NODE_BOXES; ++k) {
        small += root.child[k] != NODE_NONE && root.high[0][k] < 180.0f;
        large += root.child[k] != NODE_NONE && root.low[0][k] >= 180.0f;
    }
    EXPECT_GE(large, 12);
    EXPECT_LE(small, 4);
    EXPECT_EQ(small + large, 16);
}

// However few these are.
TEST(BoxTree, TakesFewLargeBoxesApartBeforeManySmallOnes) {
    const BoxNode root = root_of(300, 10);
    int alone = 0;
    for (int k = 0; k < NODE_BOXES; ++k)
        alone += root.child[k] != NODE_NONE && (root.child[k] & NODE_CLUSTER) != 0 &&
                 root.low[0][k] >= 300.0f;
    EXPECT_EQ(alone, 10);
}

TEST(BoxTree, KeepsListsOfWalksShort) {
    for (const std::vector<Cluster>& clusters :
         {random_clusters(20000, 9), spiral(5000), std::vector<Cluster>(70000, spiral(1)[0])}) {
        const BoxTree tree = make_box_tree(clusters);
        EXPECT_LE(put_off(tree.nodes), std::size_t{NODE_STACK}) << clusters.size();
        EXPECT_LE(tree.levels.size(), 18u) << clusters.size();
    }
    test::expect_boxes(make_box_tree(spiral(5000)).nodes, spiral(5000), "spiral");
}

TEST(BoxTree, GetsItsBoxesFromTheDevice) {
    const test::Device& on = test::device();
    Scene dust = test::plain_scene();
    test::Random random(7);
    for (int i = 0; i < 30000; ++i) {
        const glm::dvec3 at(random(-1, 1), random(-1, 1), random(-1, 1));
        test::add_triangle(dust, at, at + glm::dvec3(0.01, 0, 0.01), at + glm::dvec3(0, 0.02, 0));
    }
    Scene lone = test::plain_scene();
    test::add_triangle(lone, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    for (const std::size_t group : {std::size_t{0}, std::size_t{3}}) {
        const ScenePasses passes(test::programs(), {.local_size = group});
        for (const Scene& world : {dust, bumpy_mesh(), lone}) {
            DeviceScene scene = test::on_device(world);
            const std::vector<BoxNode> host = test::nodes_of(scene);
            test::expect_boxes(scene, "loaded");
            std::vector<BoxNode> wrong = host;
            for (BoxNode& node : wrong)
                for (int k = 0; k < NODE_BOXES; ++k)
                    for (int axis = 0; axis < 3 && node.child[k] != NODE_NONE; ++axis)
                        node.low[axis][k] = node.high[axis][k] = 0.125f;
            on.queue.enqueueWriteBuffer(scene.nodes(), CL_TRUE, 0, wrong.size() * sizeof(BoxNode),
                                        wrong.data());
            test::refit_boxes(scene, passes);
            test::expect_boxes(scene, "by the device");
        }
    }
    DeviceScene scene = test::on_device(bumpy_mesh());
    const ScenePasses passes(test::programs());
    EXPECT_THROW(passes.nodes(on.queue, scene, scene.node_levels().size() - 1), Error);
    DeviceScene none = test::on_device(Scene());
    EXPECT_THROW(passes.nodes(on.queue, none, 0), Error);
}

}  // namespace
}  // namespace clgi
