// The box around every cluster of triangles.
// [derived: minima and maxima are exact, so the boxes are those of the host at load, bit for bit]
//
// Work size    1D, one work-item a cluster; any local size; tail guarded
// Writes       its own cluster
// SPDX-License-Identifier: MIT
#include "clgi/shared/scene.h"

kernel void scene_clusters(
    const uint             triangle_count,
    global const uint4*    restrict triangles,  // [triangle_count] three vertices, material
    global const float4*   restrict positions,  // [vertex_count] local frame
    global Cluster*        restrict clusters)   // [triangle_count / CLUSTER_TRIANGLES, rounded up]
{
    uint cluster = (uint)get_global_id(0);
    uint first = cluster * CLUSTER_TRIANGLES;
    if (first >= triangle_count) return;
    uint last = min(first + CLUSTER_TRIANGLES, triangle_count);

    float4 low = positions[triangles[first].x];
    float4 high = low;
    for (uint t = first; t < last; ++t) {
        uint4 corner = triangles[t];
        float4 p[3] = {positions[corner.x], positions[corner.y], positions[corner.z]};
        for (int k = 0; k < 3; ++k) {
            // Of 0 and -0 the first one stays, here and on the host: min() may choose.
            low = select(low, p[k], p[k] < low);
            high = select(high, p[k], p[k] > high);
        }
    }
    clusters[cluster].low = (float4)(low.xyz, 0.0f);
    clusters[cluster].high = (float4)(high.xyz, 0.0f);
}
