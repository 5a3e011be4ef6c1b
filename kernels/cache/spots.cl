// VPLs on small lit places: each is the texel of its rank among those of a tile that count, and
// stands for `texels` of them.
//
//   Phi = rho I s(p) A texels       s: direct light at normal incidence (lights/direct.clh),
//                                   A: section of a texel across the light
//                                       [derived: VPLs of Keller97, by area instead of direction]
//
// Work size    1D, one work-item a VPL; any local size; tail guarded
// Writes       its own VPL
// SPDX-License-Identifier: MIT
#include "cache/sees.clh"
#include "cache/spots.clh"
#include "gbuffer/hit.clh"
#include "lights/direct.clh"

kernel void cache_spots(
    const SpotParams          params,
    const SceneInfo           info,
    global const SpotView*    restrict of,
    global const View*        restrict views,
    global const ulong*       restrict visibility,
    global const View*        restrict light_views,
    global const uint*        restrict seen,
    global const uint*        restrict wanted,
    SCENE_ARGUMENTS,
    global const Emitter*     restrict emitters,
    global const SpotSample*  restrict samples,  // [sample_count]
    global Vpl*               restrict spots)    // [sample_count]
{
    uint item = (uint)get_global_id(0), tiles = SPOT_TILES_A_VIEW;
    if (item >= params.sample_count) return;
    SceneBuffers scene = SCENE_BUFFERS;
    SpotSample sample = samples[item];
    uint light_view = of[sample.view].light_view;
    global const Emitter* emitter = emitters + of[sample.view].emitter;
    View view = views[sample.view], whole = light_views[light_view];
    uint width = view.width / SPOT_TILES, height = view.height / SPOT_TILES, passed = 0;
    Vpl out;
    out.position = out.normal = out.flux = (float4)(0.0f);
    SpotTriangle before = {-1, false};
    for (uint k = 0; k < width * height; ++k) {
        SpotTexel texel = spot_texel(emitter, &view, &whole, sample.tile % SPOT_TILES * width + k % width,
                                     sample.tile / SPOT_TILES * height + k / width, &before,
                                     visibility, seen, wanted + light_view * tiles, triangles, positions);
        if (texel.triangle < 0 || passed++ < sample.rank) continue;
        Surface surface = view_surface(&view, packet_splat(texel.x), packet_splat(texel.y),
                                       (intp)(texel.triangle), &scene, info.flags);
        ShadowPoint point = {surface.x,           surface.y,           surface.z,
                             surface.geometric_x, surface.geometric_y, surface.geometric_z};
        DirectRay ray = direct_ray(emitter, &point);
        floatp cosine = packet_dot(surface.normal_x, surface.normal_y, surface.normal_z, ray.x, ray.y,
                                   ray.z);
        floatp values[11] = {surface.x,        surface.y,        surface.z,      surface.normal_x,
                             surface.normal_y, surface.normal_z, surface.base_r, surface.base_g,
                             surface.base_b,   ray.strength,     cosine};
        float lane[11];
        for (int v = 0; v < 11; ++v) {
            float lanes[CLGI_WIDTH];
            packet_store(values[v], lanes);
            lane[v] = lanes[0];
        }
        float4 shares = materials[triangles[texel.triangle].w & TRIANGLE_MATERIAL].reflectance;
        float3 albedo = cache_albedo(shares, (float3)(lane[6], lane[7], lane[8]));
        float section = texel.area * sample.texels;
        float radius2 = section / (max(lane[10], 0.01f) * CLGI_PI);
        out.position = (float4)(lane[0], lane[1], lane[2], radius2);
        out.normal = (float4)(lane[3], lane[4], lane[5], radius2 * radius2);
        // A shading normal that faces away from the light reflects nothing of it.
        float arrives = lane[10] > 0.0f ? lane[9] * section : 0.0f;
        out.flux = (float4)(albedo * emitter->intensity.xyz * arrives, 1.0f);
        break;
    }
    spots[item] = out;
}
