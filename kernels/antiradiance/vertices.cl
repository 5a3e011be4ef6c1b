// The light of vertices that leaves share: the mean of what arrives at them, weighted by area.
//                                                              [Dachsbacher07, section 4.3]
//
// Work size    1D, one work-item a vertex; any local size; tail guarded
// Writes       the light of its vertex; what is not finite stays so
// SPDX-License-Identifier: MIT
#include "clgi/shared/antiradiance.h"

kernel void antiradiance_vertices(
    const ElementParams  params,                // count: vertices
    global const uint*   restrict first_leaves, // [vertices + 1] in leaves
    global const uint2*  restrict leaves,       // row, and the bits of its share of the vertex
    global const float4* restrict irradiances,  // [rows] rgb
    global float4*       restrict light)        // [vertices] rgb
{
    uint vertex = (uint)get_global_id(0);
    if (vertex >= params.count) return;
    float4 sum = (float4)(0.0f);
    for (uint i = first_leaves[vertex]; i < first_leaves[vertex + 1]; ++i)
        sum = fma((float4)(as_float(leaves[i].y)), irradiances[leaves[i].x], sum);
    light[vertex] = sum;
}
