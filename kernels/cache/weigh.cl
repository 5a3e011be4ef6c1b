// How much is in doubt at each place that was picked about the light that it sends.
//
//   worth = rho sqrt(spread + (CACHE_COARSE Y)^2)    rho: reflectance, Y: luminance of E there
//
// spread is what the records there differ by (lookup.clh). The second part stands for change that
// none of them shows, because all lie on one side of it.
//                              [derived: error of a source, to be weighed by importance, Smits92]
//
// Work size    1D, one work-item a pick; any local size; tail guarded
// Writes       its own worth, and the record that counts most there; CACHE_NONE where none does
// SPDX-License-Identifier: MIT
#include "cache/lookup.clh"

#define CACHE_COARSE 0.1f

kernel void cache_weigh(
    const CacheParams    params,
    const CacheTree      tree,
    global const uint*   restrict nodes,
    global const uint*   restrict lists,
    global const float*  restrict records,  // [RECORD_PLANES][tree.stride]
    global const float*  restrict light,    // [3][tree.stride] exposed lux
    global const float*  restrict places,   // [PICK_PLANES][pick_stride]
    global float*        restrict worth,    // [pick_stride] exposed lux
    global uint*         restrict nearest)  // [pick_stride]
{
    uint item = (uint)get_global_id(0);
    if (item >= params.count * params.picks) return;
    global const float* at = places + item;
    uint stride = params.pick_stride;
    float3 point = (float3)(at[0], at[stride], at[2 * stride]);
    float reflectance = at[PICK_REFLECTANCE * stride];
    at += RECORD_NORMAL * stride;
    float3 normal = (float3)(at[0], at[stride], at[2 * stride]);
    float found = 0.0f, most = 0.0f;
    uint record = CACHE_NONE;
    if (dot(normal, normal) > 0.0f) {
        CacheShare share = cache_lookup(&tree, nodes, lists, records, point, normal, CACHE_LISTED);
        CacheLight there = cache_light(&share, light, tree.stride);
        float change = CACHE_COARSE * luminance(there.irradiance.x, there.irradiance.y,
                                                there.irradiance.z);
        found = reflectance * sqrt(fma(change, change, there.spread));
        for (uint i = 0; i < share.count; ++i) {
            if (share.weight[i] <= most) continue;
            most = share.weight[i];
            record = share.record[i];
        }
    }
    worth[item] = found;
    nearest[item] = record;
}
