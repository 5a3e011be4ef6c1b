// The light of an irradiance cache at the pixels of a picture.   [derived: Ward88, interpolation]
//
//   E = sum_i W_i E_i,   doubt = sum_i W_i (Y_i - Y)^2
//
// W_i: share of record i, Y: luminance of E. Where records differ, E changes between them, and more
// of them would change it.
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       irradiance and doubt of its own pixel, 0 where nothing is or no record stands in
// SPDX-License-Identifier: MIT
#include "cache/lookup.clh"
#include "finite.clh"
#include "planes.clh"

static float cache_luminance(float r, float g, float b) {
    return 0.2126f * r + 0.7152f * g + 0.0722f * b;
}

kernel void cache_show(
    const CacheShowParams  params,
    const CacheTree        tree,
    global const uint*     restrict nodes,
    global const uint*     restrict lists,
    global const float*    restrict records,     // [RECORD_PLANES][tree.stride]
    global const float*    restrict light,       // [3][tree.stride] exposed lux
    global const float*    restrict planes,      // [>= POINT_PLANES][stride]
    global float*          restrict irradiance,  // [IRRADIANCE_PLANES][stride]
    global float*          restrict doubt)       // [stride] exposed lux squared
{
    uint at = (uint)get_global_id(0);
    if (at >= params.point_count) return;
    float3 point = gbuffer_load3(planes, GBUFFER_POSITION, params.stride, at);
    float3 normal = gbuffer_load3(planes, GBUFFER_NORMAL, params.stride, at);
    float sum[3] = {0.0f, 0.0f, 0.0f}, spread = 0.0f;
    if (!is_finite3(point) || !is_finite3(normal)) {
        for (int c = 0; c < 3; ++c) sum[c] = as_float(0x7fc00000u);
    } else if (dot(normal, normal) > 0.0f) {
        CacheShare share = cache_lookup(&tree, nodes, lists, records, point, normal,
                                        CACHE_LISTED);
        for (uint i = 0; i < share.count; ++i)
            for (int c = 0; c < 3; ++c)
                sum[c] = fma(share.weight[i], light[c * tree.stride + share.record[i]], sum[c]);
        float mean = cache_luminance(sum[0], sum[1], sum[2]);
        for (uint i = 0; i < share.count; ++i) {
            global const float* of = light + share.record[i];
            float off = cache_luminance(of[0], of[tree.stride], of[2 * tree.stride]) - mean;
            spread = fma(share.weight[i] * off, off, spread);
        }
    }
    doubt[at] = spread;
    for (int c = 0; c < 3; ++c)
        row_store_one(sum[c], irradiance_row(irradiance, c, params.stride), at);
}
