// Projects every vertex into a view, once, to 1/256 of a pixel.
// [derived: integer corners make the edge functions exact, so a shared edge covers a pixel once]
//
// Work size    1D, one work-item a vertex; any local size; tail guarded
// Writes       only its own vertex
// SPDX-License-Identifier: MIT
#include "gbuffer/project.clh"

kernel void gbuffer_transform(
    const View                  view,
    const uint                  vertex_count,
    global const float4* restrict positions,  // [vertex_count] local frame
    global ScreenVertex* restrict vertices)   // [vertex_count]
{
    uint vertex = (uint)get_global_id(0);
    if (vertex >= vertex_count) return;

    ScreenVertex out;
    float3 p = gbuffer_to_view(&view, positions[vertex]);
    // A guard band a little narrower than the integers: what crosses it is clipped.
    float2 guard = 2.0f * (float)GUARD_PIXELS / (float2)((float)view.width, (float)view.height) - 1.0f;
    float2 window = gbuffer_to_window(&view, p);
    if (!(p.z >= view.forward.w)) {
        out.x = 0;
        out.y = 0;
        out.closeness = 0.0f;
        out.outside = VERTEX_BEFORE_NEAR;
    } else if (!(fabs(window.x) <= guard.x && fabs(window.y) <= guard.y)) {
        out.x = 0;
        out.y = 0;
        out.closeness = gbuffer_closeness(&view, p.z);
        out.outside = VERTEX_BEYOND_GUARD;
    } else {
        int2 corner = gbuffer_to_subpixels(&view, window);
        out.x = corner.x;
        out.y = corner.y;
        out.closeness = gbuffer_closeness(&view, p.z);
        out.outside = 0;
    }
    vertices[vertex] = out;
}
