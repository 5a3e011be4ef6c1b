// The light of an irradiance cache at the pixels of a picture.   [derived: Ward88, interpolation]
//
// Doubt is how much the records of a pixel differ (lookup.clh): where they do, light changes between
// them, and more of them would change it.
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       irradiance and doubt of its own pixel, 0 where nothing is or no record stands in
// SPDX-License-Identifier: MIT
#include "cache/lookup.clh"
#include "finite.clh"
#include "planes.clh"

kernel void cache_show(
    const CacheShowParams  params,
    const CacheTree        tree,
    global const uint*     restrict nodes,
    global const uint*     restrict lists,
    global const float*    restrict records,     // [RECORD_PLANES][tree.stride]
    global const float*    restrict light,       // [3][tree.stride] exposed lux
    global const float*    restrict planes,      // [>= POINT_PLANES][stride]
    global const float*    restrict more,        // as light, read where params.more is 1
    global float*          restrict irradiance,  // [IRRADIANCE_PLANES][stride]
    global float*          restrict doubt,       // [stride] exposed lux squared
    global float*          restrict of_more)     // as irradiance, of `more`
{
    uint at = (uint)get_global_id(0);
    if (at >= params.point_count) return;
    float3 point = gbuffer_load3(planes, GBUFFER_POSITION, params.stride, at);
    float3 normal = gbuffer_load3(planes, GBUFFER_NORMAL, params.stride, at);
    float sum[3] = {0.0f, 0.0f, 0.0f}, second[3] = {0.0f, 0.0f, 0.0f}, spread = 0.0f;
    if (!is_finite3(point) || !is_finite3(normal)) {
        for (int c = 0; c < 3; ++c) sum[c] = second[c] = as_float(0x7fc00000u);
    } else if (dot(normal, normal) > 0.0f) {
        CacheShare share = cache_lookup(&tree, nodes, lists, records, point, normal,
                                        CACHE_LISTED);
        cache_carry_on(&share);
        CacheLight found = cache_light(&share, light, tree.stride);
        sum[0] = found.irradiance.x;
        sum[1] = found.irradiance.y;
        sum[2] = found.irradiance.z;
        spread = found.spread;
        if (params.more) {
            found = cache_light(&share, more, tree.stride);
            second[0] = found.irradiance.x;
            second[1] = found.irradiance.y;
            second[2] = found.irradiance.z;
        }
    }
    doubt[at] = spread;
    for (int c = 0; c < 3; ++c)
        row_store_one(sum[c], irradiance_row(irradiance, c, params.stride), at);
    if (!params.more) return;
    for (int c = 0; c < 3; ++c)
        row_store_one(second[c], irradiance_row(of_more, c, params.stride), at);
}
