// The boxes of one level of the tree over clusters, from those of clusters and of the level below.
//                                                     [derived: minima and maxima of their boxes]
//
// Work size    1D, one work-item a node of the level; any local size; tail guarded
// Writes       the boxes of its own node; which clusters and nodes it has stays
// SPDX-License-Identifier: MIT
#include "clgi/shared/scene.h"

kernel void scene_nodes(
    const uint             first,     // node of the level
    const uint             count,
    global const Cluster*  restrict clusters,
    global BoxNode*        nodes)     // those of the level below are read
{
    uint item = (uint)get_global_id(0);
    if (item >= count) return;
    global BoxNode* node = nodes + first + item;
    for (uint k = 0; k < NODE_BOXES; ++k) {
        uint child = node->child[k];
        if (child == NODE_NONE) continue;
        if (child & NODE_CLUSTER) {
            global const Cluster* cluster = clusters + (child & ~NODE_CLUSTER);
            node->low[0][k] = cluster->low.x;
            node->low[1][k] = cluster->low.y;
            node->low[2][k] = cluster->low.z;
            node->high[0][k] = cluster->high.x;
            node->high[1][k] = cluster->high.y;
            node->high[2][k] = cluster->high.z;
            continue;
        }
        global const BoxNode* below = nodes + child;
        for (uint axis = 0; axis < 3; ++axis) {
            float low = below->low[axis][0], high = below->high[axis][0];
            for (uint n = 1; n < NODE_BOXES; ++n) {
                low = min(low, below->low[axis][n]);
                high = max(high, below->high[axis][n]);
            }
            node->low[axis][k] = low;
            node->high[axis][k] = high;
        }
    }
}
