// Turns a visibility buffer into the planes of a G-buffer: the set of surface points S_cam.
//
// Every pixel's ray is met with the plane of its triangle, which gives perspective-correct
// attributes without any per-triangle set-up.                       [Cochran07, section 3.2]
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       its own pixels of the planes asked for; past the last pixel of the view, inside
//              the stride, zeros
// SPDX-License-Identifier: MIT
#include "gbuffer/detail.clh"
#include "gbuffer/visibility.clh"
#include "gbuffer/window.clh"
#include "planes.clh"

// Triangles of a packet of pixels; -1 past the last. The lower half of a word is the triangle, and
// all bits set, which stands for nothing, is -1 there as well.
static intp visible_triangles(global const ulong* words, uint pixel, uint pixels) {
    if (pixel + CLGI_WIDTH <= pixels) {
        global const int* halves = (global const int*)(words + pixel);
#if CLGI_WIDTH == 1
        return halves[0];
#else
        return (intp)(packet_load(halves).even, packet_load(halves + CLGI_WIDTH).even);
#endif
    }
    int lanes[CLGI_WIDTH];
    for (uint k = 0; k < CLGI_WIDTH; ++k)
        lanes[k] = pixel + k < pixels ? visibility_triangle(words[pixel + k]) : -1;
    return packet_load(lanes);
}

kernel void gbuffer_resolve(
    const View             view,
    const ResolveParams    params,
    const SceneInfo        info,
    SCENE_ARGUMENTS,
    global const ulong*    restrict visibility,  // [pixels of all views]
    global float*          restrict planes,      // [GBUFFER_PLANES][stride]
    global int*            restrict ids)         // [GBUFFER_ID_PLANES][stride]
{
    uint pixel = (uint)get_global_id(0) * CLGI_WIDTH;
    uint pixels = view.width * view.height;
    if (pixel >= pixels) return;

    SceneBuffers scene = SCENE_BUFFERS;
    intp triangle = visible_triangles(visibility + view.first_pixel, pixel, pixels);
    intp material = (intp)(-1);
    if (packet_any(triangle >= 0)) {
        int lanes[CLGI_WIDTH];
        packet_store(triangle, lanes);
        if (packet_any(triangle != lanes[0])) {
            for (int k = 0; k < CLGI_WIDTH; ++k)
                if (lanes[k] >= 0) lanes[k] = (int)(triangles[lanes[k]].w & TRIANGLE_MATERIAL);
            material = packet_load(lanes);
        } else {
            material = (intp)((int)(triangles[lanes[0]].w & TRIANGLE_MATERIAL));
        }
    }

    floatp x, y;
    gbuffer_window(&view, pixel, &x, &y);
    ViewRays rays = view_rays(&view, x, y);
    Surface surface = ray_surface(&view, &rays, triangle, &scene, info.flags);

    uint stride = params.stride;
    gbuffer_store3(surface.x, surface.y, surface.z, planes, GBUFFER_POSITION, stride, pixel);
    gbuffer_store3(surface.normal_x, surface.normal_y, surface.normal_z, planes, GBUFFER_NORMAL,
                   stride, pixel);
    if (params.write & RESOLVE_GEOMETRIC)
        gbuffer_store3(surface.geometric_x, surface.geometric_y, surface.geometric_z, planes,
                       GBUFFER_GEOMETRIC, stride, pixel);
    gbuffer_store3(surface.base_r, surface.base_g, surface.base_b, planes, GBUFFER_BASE, stride,
                   pixel);
    if (params.write & RESOLVE_EMISSION)
        gbuffer_store3(surface.emission_r, surface.emission_g, surface.emission_b, planes,
                       GBUFFER_EMISSION, stride, pixel);
    if (params.write & RESOLVE_DEPTH)
        row_store(surface.depth, gbuffer_row(planes, GBUFFER_DEPTH, stride), pixel);
    packet_store(material, ids + GBUFFER_MATERIAL * stride + pixel);
    intp mapped, metallic_roughness;
    gbuffer_detail(&rays, triangle, &scene, info.flags, &surface, &mapped, &metallic_roughness);
    packet_store(mapped, ids + GBUFFER_MAPPED_NORMAL * stride + pixel);
    packet_store(metallic_roughness, ids + GBUFFER_METALLIC_ROUGHNESS * stride + pixel);
    if (params.write & RESOLVE_TRIANGLE)
        packet_store(triangle, ids + GBUFFER_TRIANGLE * stride + pixel);
}
