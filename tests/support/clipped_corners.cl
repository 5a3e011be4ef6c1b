// Projects every vertex as corners of clipped polygons are.
// SPDX-License-Identifier: MIT
#include "gbuffer/project.clh"

kernel void clipped_corners(
    const View                    view,
    global const float4* restrict positions,  // [vertex_count] local frame
    global int4*         restrict projected)  // [vertex_count] x, y, closeness, 0
{
    uint vertex = (uint)get_global_id(0);
    float3 p = gbuffer_to_view(&view, positions[vertex]);
    int2 pixel = gbuffer_to_subpixels(&view, gbuffer_to_window(&view, p));
    projected[vertex] = (int4)(pixel, as_int(gbuffer_closeness(&view, p.z)), 0);
}
