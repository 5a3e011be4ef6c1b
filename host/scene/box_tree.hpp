// The tree of boxes over clusters (BoxNode, clgi/shared/scene.h).
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/scene.h>
#include <cstdint>
#include <vector>

namespace clgi {

struct BoxTree {
    std::vector<BoxNode> nodes;  // the root first, then level by level
    // The first node of each level, and how many there are of all; of no clusters only 0.
    std::vector<std::uint32_t> levels;
};

// Every node has consecutive clusters below it. Where a run of them is cut follows the areas of
// boxes [Goldsmith87: costs of a hierarchy by areas], and the run with the largest box is cut
// first.
BoxTree make_box_tree(const std::vector<Cluster>& clusters);

}  // namespace clgi
