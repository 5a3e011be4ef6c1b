// Light of records such that the interpolation between them keeps what it would blur. It is a mean of
// what stands around (lookup.clh): too bright where light falls off in a curve, as beside lamps, too
// dark on crests. At the records themselves the difference is known:
//
//   E_i' = E_i + f (E_i - M E_i),   M E_i = sum_j W_j(x_i) E_j
//   f = 1 / (1 + r^2) where E_i is above M E_i, else min(1, 1 / r),
//   r = |E_i - M E_i| / (SHARPEN_MOST |E_i|)                      [Tukey77: twicing; derived: f]
//
// f: of each channel. On the dark side of an edge that is sharper than the records' spacing, all of the
// difference would leave less than no light; a record far above those around it stands where they do
// not resolve the light, and more of it would be carried to where it is not. Where no record stands in
// for another one, not even itself, it stays as it is. A second light is sharpened by the first one's
// f: both go through one linear map, so that the mean of what corrects the one by the other stays
// right.
//
// Work size    1D, one work-item for every CLGI_WIDTH records (rounded up); any local size
// Writes       light of its own packet of records
// Cost         as show.cl a record
// SPDX-License-Identifier: MIT
#include "cache/lookup.clh"

#define SHARPEN_MOST 0.5f

kernel void cache_sharpen(
    const CacheSharpenParams  params,
    const CacheTree           tree,
    global const uint*        restrict nodes,
    global const uint*        restrict lists,
    global const float*       restrict records,     // [RECORD_PLANES][tree.stride]
    global const float*       restrict light,       // [3][tree.stride]
    global float*             restrict sharpened,   // [3][tree.stride]
    global const float*       restrict more,        // as light, read where params.more is 1
    global float*             restrict more_sharpened)
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH, stride = tree.stride;
    if (at >= tree.record_count) return;
    CacheVector point, normal;
    packet_load3(records + at, stride, &point.x, &point.y, &point.z);
    packet_load3(records + RECORD_NORMAL * stride + at, stride, &normal.x, &normal.y, &normal.z);
    CacheShare share;
    CacheVector places[CACHE_LISTED];
    cache_lookup(&tree, nodes, lists, records, point, normal, params.most, &share, places);
    if (params.carried) cache_carry_on(&share, places);
    floatp all = packet_zero;
    for (uint i = 0; i < share.count; ++i) all += share.weight[i];
    for (uint c = 0; c < 3; ++c) {
        uint row = c * stride;
        floatp own = packet_load(light + row + at), off = own - cache_mean(&share, light + row);
        floatp most = SHARPEN_MOST * fabs(own), ratio = off / (most + FLT_MIN), size = fabs(off);
        floatp part = packet_select(packet_splat(1.0f), most / size, size > most);
        part = packet_select(part, 1.0f / fma(ratio, ratio, packet_splat(1.0f)), off > 0.0f);
        part = packet_select(packet_zero, part, all > 0.0f);
        packet_store(fma(part, off, own), sharpened + row + at);
        if (!params.more) continue;
        own = packet_load(more + row + at);
        off = own - cache_mean(&share, more + row);
        packet_store(fma(part, off, own), more_sharpened + row + at);
    }
}
