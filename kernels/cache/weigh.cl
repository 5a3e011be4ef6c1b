// How much is in doubt at each place that was picked about the light that it sends.
//
//   worth = rho sqrt(spread + (CACHE_COARSE Y)^2)    rho: reflectance, Y: luminance of E there
//
// spread is what the records there differ by (lookup.clh). The second part stands for change that
// none of them shows, because all lie on one side of it.
//                              [derived: error of a source, to be weighed by importance, Smits92]
//
// Work size    1D, one work-item for every CLGI_WIDTH picks (rounded up); any local size
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
    uint item = (uint)get_global_id(0) * CLGI_WIDTH;
    if (item >= params.count * params.picks) return;
    uint stride = params.pick_stride;
    CacheVector point, normal;
    packet_load3(places + item, stride, &point.x, &point.y, &point.z);
    packet_load3(places + RECORD_NORMAL * stride + item, stride, &normal.x, &normal.y, &normal.z);
    CacheShare share;
    cache_lookup(&tree, nodes, lists, records, point, normal, CACHE_LISTED, &share, 0);
    CacheVector there = cache_light(&share, light, tree.stride);
    floatp change = CACHE_COARSE * luminance(there.x, there.y, there.z), most = packet_zero;
    floatp spread = cache_spread(&share, light, tree.stride, there);
    intp record = (intp)((int)CACHE_NONE);
    for (uint i = 0; i < share.count; ++i) {
        intp more = share.weight[i] > most;
        most = packet_select(most, share.weight[i], more);
        record = packet_select(record, packet_load(share.record[i]), more);
    }
    floatp reflectance = packet_load(places + PICK_REFLECTANCE * stride + item);
    packet_store(reflectance * sqrt(fma(change, change, spread)), worth + item);
    packet_store(as_uintp(record), nearest + item);
}
