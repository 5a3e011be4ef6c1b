// Points of the surface -> the planes of a G-buffer.
// [derived: barycentric interpolation, see gbuffer/surface.clh]
//
// Work size    1D, one work-item for every CLGI_WIDTH samples (rounded up); any local size
// Writes       its own points of planes and ids, front side, depth 0; with write_uvs the texture
//              coordinates of both sets; past the last sample, inside the packet, zeros
// SPDX-License-Identifier: MIT
#include "gbuffer/surface.clh"
#include "planes.clh"

kernel void gbuffer_surface(
    const SurfaceParams          params,
    const SceneInfo              info,
    SCENE_ARGUMENTS,
    global const SurfaceSample*  restrict samples,  // [sample_count]
    global float*                restrict planes,   // [GBUFFER_PLANES][stride]
    global int*                  restrict ids,      // [GBUFFER_ID_PLANES][stride]
    global float*                restrict coords)   // [4][stride] u0, v0, u1, v1
{
    uint point = (uint)get_global_id(0) * CLGI_WIDTH;
    if (point >= params.sample_count) return;
    SceneBuffers scene = SCENE_BUFFERS;
    int lane_triangle[CLGI_WIDTH], lane_material[CLGI_WIDTH];
    float lane_b1[CLGI_WIDTH], lane_b2[CLGI_WIDTH], lane_footprint[CLGI_WIDTH];
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        int there = point + k < params.sample_count;
        SurfaceSample sample = samples[there ? point + k : point];
        there = there && sample.triangle < info.triangle_count;
        lane_triangle[k] = there ? (int)sample.triangle : -1;
        lane_material[k] = there ? (int)(triangles[sample.triangle].w & TRIANGLE_MATERIAL) : -1;
        lane_b1[k] = sample.b1;
        lane_b2[k] = sample.b2;
        lane_footprint[k] = sample.footprint;
    }
    intp triangle = packet_load(lane_triangle);
    floatp b1 = packet_load(lane_b1), b2 = packet_load(lane_b2);
    Surface surface = surface_at(triangle, b1, b2, packet_load(lane_footprint), &scene, info.flags);

    uint stride = params.stride;
    gbuffer_store3(surface.x, surface.y, surface.z, planes, GBUFFER_POSITION, stride, point);
    gbuffer_store3(surface.normal_x, surface.normal_y, surface.normal_z, planes, GBUFFER_NORMAL,
                   stride, point);
    gbuffer_store3(surface.geometric_x, surface.geometric_y, surface.geometric_z, planes,
                   GBUFFER_GEOMETRIC, stride, point);
    gbuffer_store3(surface.base_r, surface.base_g, surface.base_b, planes, GBUFFER_BASE, stride,
                   point);
    gbuffer_store3(surface.emission_r, surface.emission_g, surface.emission_b, planes,
                   GBUFFER_EMISSION, stride, point);
    row_store(surface.depth, gbuffer_row(planes, GBUFFER_DEPTH, stride), point);
    packet_store(packet_load(lane_material), ids + GBUFFER_MATERIAL * stride + point);
    packet_store(triangle, ids + GBUFFER_TRIANGLE * stride + point);
    packet_store((intp)(-1), ids + GBUFFER_MAPPED_NORMAL * stride + point);
    packet_store((intp)(-1), ids + GBUFFER_METALLIC_ROUGHNESS * stride + point);
    if (!params.write_uvs) return;
    floatp both[4];
    surface_uvs(triangle, b1, b2, &scene, info.flags, both);
    for (int c = 0; c < 4; ++c) packet_store(both[c], coords + c * stride + point);
}
