// What arrives at records from all that their hemicubes see: a row of the transport, and what does
// not depend on other records, the light of the sky and of emission, and direct light once reflected.
//
//   E_i = B_i + R_i + sum_j T_ij E_j
//   T_ij = sum over pixels w rho W_j,   B_i = sum w pi L,   R_i = sum w rho D
//
// w: form factor of a pixel, rho: albedo of the surface in it, lobes taken for diffuse, W_j: share of record j in it
// (lookup.clh), D: direct light there, by shadow maps (lights/direct.clh). E has no direct light.
// Sample points of emissive surfaces, of which there may be hundreds, take turns from one block of
// 16 pixels to the next.        [derived: radiosity of points, gathered by hemicubes]
//
// Work size    1D, one work-item a record; any local size; tail guarded
// Writes       its own row and its own base light
// Cost         some 300 flops a pixel that shows a surface, and 60 for each emitter; 60 and a look-up
//              one that shows the sky
// SPDX-License-Identifier: MIT
#include "cache/lookup.clh"
#include "cache/sees.clh"
#include "gbuffer/hit.clh"
#include "gbuffer/window.clh"
#include "lights/direct.clh"
#include "lobe_mean.clh"

// pi times the radiance that comes from a direction, without the sky's factor.
static float3 cache_sky(const CacheParams* params, global const float* texels, float3 d) {
    float u = atan2(d.x, -d.z) * (0.5f / CLGI_PI) + (0.5f + params->sky_turn);
    float v = atan2(sqrt(d.x * d.x + d.z * d.z), d.y) * (1.0f / CLGI_PI);
    u -= floor(u);
    uint x = min((uint)(u * (float)params->sky_width), params->sky_width - 1);
    uint y = min((uint)(v * (float)params->sky_height), params->sky_height - 1);
    return vload3(y * params->sky_width + x, texels);
}

// Whether the middle of a triangle lies outside the focus (host/shading/lights/emitters.cpp).
static int cache_is_beyond(const CacheParams* params, global const float4* positions, uint4 words) {
    float3 middle = (positions[words.x].xyz + positions[words.y].xyz + positions[words.z].xyz) *
                    (1.0f / 3.0f);
    return dot(middle, middle) > params->focus;
}

kernel void cache_link(
    const CacheParams    params,
    const CacheTree      tree,
    const SceneInfo      info,
    global const View*   restrict views,       // five of each record
    global const ulong*  restrict visibility,  // of all records
    global const uint*   restrict nodes,
    global const uint*   restrict lists,
    global const float*  restrict planes,      // [RECORD_PLANES][stride] of all records
    global const float*  restrict sky,         // [sky_height][sky_width][3]
    SCENE_ARGUMENTS,
    global const Emitter*  restrict emitters,  // [emitter_count]
    global const View*   restrict light_views,
    global const uint*   restrict shadow_maps,
    global float*        restrict rows,        // [record][3][stride]
    global float*        restrict base,        // [3][stride] B, exposed lux
    global float*        restrict reflected)   // [3][stride] R
{
    uint item = (uint)get_global_id(0);
    if (item >= params.count) return;
    SceneBuffers scene = SCENE_BUFFERS;
    uint record = params.first + item;
    uint stride = params.stride;
    global float* row = rows + (ulong)record * 3 * stride;
    for (uint k = 0; k < 3 * stride; ++k) row[k] = 0.0f;
    float3 own = (float3)(0.0f), above = (float3)(0.0f), once = (float3)(0.0f);
    ShadowMaps maps = {shadow_maps, 1};
    float all = 0.0f;
    global const float* normal = planes + RECORD_NORMAL * stride + record;
    int valid = normal[0] != 0.0f || normal[stride] != 0.0f || normal[2 * stride] != 0.0f;
    for (uint face = 0; valid && face < 5; ++face) {
        View view = views[5 * record + face];
        uint pixels = view.width * view.height;
        for (uint pixel = 0; pixel < pixels; pixel += CLGI_WIDTH) {
            uint block = pixel / 16 + 5 * face + record;
            // Shifted now and then, or rows of so many blocks would always have the same ones.
            if ((block + pixel / (16 * params.thin)) % params.thin != 0) continue;
            floatp x, y;
            gbuffer_window(&view, pixel, &x, &y);
            floatp factor = cache_form_factor(face, params.size, x, y);
            intp triangle = cache_triangles(visibility + view.first_pixel + pixel);
            float factors[CLGI_WIDTH], right[CLGI_WIDTH], up[CLGI_WIDTH];
            int seen[CLGI_WIDTH];
            packet_store(factor, factors);
            packet_store(triangle, seen);
            for (int k = 0; k < CLGI_WIDTH; ++k) all += factors[k];
            if (packet_any(triangle < 0) && params.sky_width > 0) {
                packet_store(x, right);
                packet_store(y, up);
                for (int k = 0; k < CLGI_WIDTH; ++k) {
                    if (seen[k] >= 0) continue;
                    float3 d = view.forward.xyz + right[k] * view.right.xyz + up[k] * view.up.xyz;
                    above += factors[k] * cache_sky(&params, sky, d);
                }
            }
            if (!packet_any(triangle >= 0)) continue;
            Surface surface = gbuffer_surface(&view, x, y, triangle, &scene, info.flags);
            floatp lit[3] = {packet_zero, packet_zero, packet_zero};
            ShadowPoint point = {surface.x,           surface.y,           surface.z,
                                 surface.geometric_x, surface.geometric_y, surface.geometric_z};
            uint step = params.emitter_step, turn = block / params.thin % step;
            uint in_turn = (params.emitter_count - params.whole_emitters + step - 1 - turn) / step;
            for (uint k = 0; k < params.whole_emitters + in_turn; ++k) {
                int whole = k < params.whole_emitters;
                global const Emitter* emitter =
                    emitters + (whole ? k : k + turn + (k - params.whole_emitters) * (step - 1));
                DirectRay ray = direct_ray(emitter, &point);
                floatp arriving =
                    direct_arriving(emitter, light_views, &maps, &point, surface.normal_x,
                                    surface.normal_y, surface.normal_z, &ray, 1.0f);
                float counts = whole ? 1.0f : (float)step;
                lit[0] = fma(arriving, packet_splat(counts * emitter->intensity.x), lit[0]);
                lit[1] = fma(arriving, packet_splat(counts * emitter->intensity.y), lit[1]);
                lit[2] = fma(arriving, packet_splat(counts * emitter->intensity.z), lit[2]);
            }
            float direct[3][CLGI_WIDTH];
            packet_store(lit[0], direct[0]);
            packet_store(lit[1], direct[1]);
            packet_store(lit[2], direct[2]);
            float at[9][CLGI_WIDTH];
            int front[CLGI_WIDTH];
            packet_store(surface.x, at[0]);
            packet_store(surface.y, at[1]);
            packet_store(surface.z, at[2]);
            packet_store(surface.normal_x, at[3]);
            packet_store(surface.normal_y, at[4]);
            packet_store(surface.normal_z, at[5]);
            packet_store(surface.base_r, at[6]);
            packet_store(surface.base_g, at[7]);
            packet_store(surface.base_b, at[8]);
            packet_store(surface.front, front);
            float glow[3][CLGI_WIDTH];
            packet_store(surface.emission_r, glow[0]);
            packet_store(surface.emission_g, glow[1]);
            packet_store(surface.emission_b, glow[2]);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                if (seen[k] < 0) continue;
                uint words = triangles[seen[k]].w;
                if (!front[k] && !(words & (uint)TRIANGLE_DOUBLE_SIDED)) continue;
                float3 radiance = (float3)(glow[0][k], glow[1][k], glow[2][k]);
                if (dot(radiance, radiance) > 0.0f &&
                    (params.emission == CACHE_EMISSION_ALL ||
                     cache_is_beyond(&params, positions, triangles[seen[k]])))
                    own += factors[k] * CLGI_PI * radiance;
                CacheShare share = cache_lookup(&tree, nodes, lists, planes,
                                                (float3)(at[0][k], at[1][k], at[2][k]),
                                                (float3)(at[3][k], at[4][k], at[5][k]), CACHE_FEW);
                float4 shares = materials[words & TRIANGLE_MATERIAL].reflectance;
                shares.yz *= lobe_mean(shares.w);
                float3 rho = factors[k] *
                             ((shares.x + shares.z) * (float3)(at[6][k], at[7][k], at[8][k]) + shares.y);
                once += rho * (float3)(direct[0][k], direct[1][k], direct[2][k]);
                for (uint i = 0; i < share.count; ++i) {
                    global float* to = row + share.record[i];
                    to[0] += share.weight[i] * rho.x;
                    to[stride] += share.weight[i] * rho.y;
                    to[2 * stride] += share.weight[i] * rho.z;
                }
            }
        }
    }
    // The pixels' form factors sum to 1 but for the midpoint rule.
    float scale = all > 0.0f ? 1.0f / all : 0.0f;
    for (uint k = 0; k < 3 * stride; ++k) row[k] *= scale;
    own = scale * (own + CLGI_PI * above * params.sky.xyz);
    base[record] = own.x;
    base[stride + record] = own.y;
    base[2 * stride + record] = own.z;
    reflected[record] = scale * once.x;
    reflected[stride + record] = scale * once.y;
    reflected[2 * stride + record] = scale * once.z;
}
