// Corners of the triangles that block, one plane for each coordinate, and a box around each cluster
// of 64 consecutive triangles [Kautz04, section 3.2, hierarchical culling].
//
// A triangle with a number that is not finite is counted and becomes a point, which blocks nothing.
// The last cluster is filled with such points; a cluster without triangles to draw has its box
// there.                                                  [derived: minima and maxima are exact]
//
// Work size    1D, one work-item a cluster; any local size; tail guarded
// Writes       corners and box of its cluster; adds to status
// SPDX-License-Identifier: MIT
#include "clgi/shared/masks.h"
#include "finite.clh"

kernel void transfer_blockers(
    const BlockerParams     params,
    global const uint4*     restrict triangles,  // [triangle_count] three vertices, and no matter
    global const float4*    restrict positions,  // local frame
    global float*           restrict corners,    // [BLOCKER_PLANES][stride]
    global BlockerBox*      restrict boxes,      // [stride / BLOCKER_CLUSTER]
    global uint*            restrict status)     // [MASK_STATUS_WORDS]
{
    uint cluster = (uint)get_global_id(0);
    uint first = cluster * BLOCKER_CLUSTER;
    if (first >= params.triangle_count) return;
    float3 low = (float3)(0.0f), high = (float3)(0.0f);
    int started = 0;
    uint bad = 0;
    for (uint t = first; t < first + BLOCKER_CLUSTER; ++t) {
        float3 p[3] = {low, low, low};
        if (t < params.triangle_count) {
            uint4 corner = triangles[t];
            float3 a = positions[corner.x].xyz;
            float3 b = positions[corner.y].xyz;
            float3 c = positions[corner.z].xyz;
            if (is_finite3(a) && is_finite3(b) && is_finite3(c)) {
                if (!started) low = high = a;
                started = 1;
                low = fmin(low, fmin(a, fmin(b, c)));
                high = fmax(high, fmax(a, fmax(b, c)));
                p[0] = a;
                p[1] = b;
                p[2] = c;
            } else {
                ++bad;
            }
        }
        for (int k = 0; k < 3; ++k) {
            corners[(3 * k) * params.stride + t] = p[k].x;
            corners[(3 * k + 1) * params.stride + t] = p[k].y;
            corners[(3 * k + 2) * params.stride + t] = p[k].z;
        }
    }
    boxes[cluster].low = (float4)(low, 0.0f);
    boxes[cluster].high = (float4)(high, 0.0f);
    if (bad) atomic_add(status + MASK_BAD_BLOCKERS, bad);
}
