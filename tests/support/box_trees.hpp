// What holds of every tree of boxes over clusters.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>
#include <algorithm>
#include <clgi/passes/scene.hpp>
#include <limits>
#include <string>

#include "device.hpp"

namespace clgi::test {

// Each box is the least around its cluster or around all boxes of its node, places without a child
// hold nothing, and no child but the root's is in two places.
inline void expect_boxes(const std::vector<BoxNode>& nodes, const std::vector<Cluster>& clusters,
                         const std::string& label) {
    std::vector<int> nodes_met(nodes.size(), 0), clusters_met(clusters.size(), 0);
    for (std::size_t i = 0; i < nodes.size(); ++i)
        for (int k = 0; k < NODE_BOXES; ++k) {
            const std::uint32_t child = nodes[i].child[k];
            glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
            if (child == NODE_NONE) {
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_GT(nodes[i].low[axis][k], nodes[i].high[axis][k]) << label;
                continue;
            }
            if (child & NODE_CLUSTER) {
                const std::uint32_t c = child & ~NODE_CLUSTER;
                ASSERT_LT(c, clusters.size()) << label;
                ++clusters_met[c];
                low = glm::vec3(clusters[c].low);
                high = glm::vec3(clusters[c].high);
            } else {
                ASSERT_LT(child, nodes.size()) << label;
                ASSERT_GT(child, i) << label;
                ++nodes_met[child];
                for (int n = 0; n < NODE_BOXES; ++n)
                    for (int axis = 0; axis < 3; ++axis) {
                        if (nodes[child].child[n] == NODE_NONE) continue;
                        low[axis] = std::min(low[axis], nodes[child].low[axis][n]);
                        high[axis] = std::max(high[axis], nodes[child].high[axis][n]);
                    }
            }
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_EQ(nodes[i].low[axis][k], low[axis]) << label << ", " << i << ", " << k;
                EXPECT_EQ(nodes[i].high[axis][k], high[axis]) << label << ", " << i << ", " << k;
            }
        }
    for (std::size_t i = 1; i < nodes.size(); ++i) EXPECT_EQ(nodes_met[i], 1) << label << ", " << i;
    for (std::size_t c = 0; c < clusters.size(); ++c)
        EXPECT_EQ(clusters_met[c], 1) << label << ", " << c;
}

// The boxes of all levels anew, by the device.
inline void refit_boxes(DeviceScene& scene, const ScenePasses& passes) {
    WaitList last;
    for (std::size_t level = scene.node_levels().size() - 1; level-- > 0;)
        last.assign(1, passes.nodes(device().queue, scene, level, last));
}

inline std::vector<BoxNode> nodes_of(const DeviceScene& scene) {
    return download<BoxNode>(scene.nodes(), scene.node_levels().back());
}

inline void expect_boxes(const DeviceScene& scene, const std::string& label) {
    expect_boxes(nodes_of(scene), download<Cluster>(scene.clusters(), scene.info().cluster_count),
                 label);
}

}  // namespace clgi::test
