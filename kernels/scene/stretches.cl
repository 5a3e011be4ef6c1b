// The box around every sixteen clusters.             [derived: minima and maxima of their boxes]
//
// Work size    1D, one work-item a stretch; any local size; tail guarded
// Writes       its own stretch
// SPDX-License-Identifier: MIT
#include "clgi/shared/scene.h"

kernel void scene_stretches(
    const uint             cluster_count,
    global const Cluster*  restrict clusters,   // [cluster_count]
    global Stretch*        restrict stretches)  // [cluster_count / STRETCH_CLUSTERS, rounded up]
{
    uint stretch = (uint)get_global_id(0);
    uint first = stretch * STRETCH_CLUSTERS;
    if (first >= cluster_count) return;
    float4 low = clusters[first].low, high = clusters[first].high;
    for (uint c = first + 1; c < min(first + STRETCH_CLUSTERS, cluster_count); ++c) {
        low = select(low, clusters[c].low, clusters[c].low < low);
        high = select(high, clusters[c].high, clusters[c].high > high);
    }
    stretches[stretch].low = low;
    stretches[stretch].high = high;
}
