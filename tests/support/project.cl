// Projects every vertex into a view by the arithmetic of the rasteriser.
// SPDX-License-Identifier: MIT
#include "gbuffer/triangles.clh"

kernel void project(
    const View                    view,
    global const float4* restrict positions,  // [vertex_count] local frame
    global int4*         restrict projected)  // [vertex_count] x, y, closeness, VERTEX_...
{
    uint vertex = (uint)get_global_id(0);
    float4 position = positions[vertex];
    CornerPacket corner = triangles_corner(&view, position.x, position.y, position.z);
    projected[vertex] = (int4)(corner.x, corner.y, as_int(triangles_closeness(&view, corner.z)),
                               corner.outside);
}
