// The light of an irradiance cache at the pixels of a picture.   [derived: Ward88, interpolation]
//
// Doubt is how much the records of a pixel differ (lookup.clh): where they do, light changes between
// them, and more of them would change it.
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       irradiance and doubt of its own pixels, 0 where nothing is or no record stands in
// SPDX-License-Identifier: MIT
#include "cache/lookup.clh"

static uintp cache_magnitude(CacheVector v) {
    return max(packet_magnitude(v.x), max(packet_magnitude(v.y), packet_magnitude(v.z)));
}

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
    uint at = (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.point_count) return;
    CacheVector point = cache_points(planes, GBUFFER_POSITION, params.stride, at);
    CacheVector normal = cache_points(planes, GBUFFER_NORMAL, params.stride, at);
    floatp none = packet_splat(as_float(0x7fc00000u));
    intp broken = max(cache_magnitude(point), cache_magnitude(normal)) >= NOT_FINITE;
    CacheShare share;
    CacheVector places[CACHE_LISTED];
    cache_lookup(&tree, nodes, lists, records, point, normal, CACHE_LISTED, &share, places);
    cache_carry_on(&share, places);
    CacheVector found = cache_light(&share, light, tree.stride);
    floatp spread = cache_spread(&share, light, tree.stride, found);
    packet_store(packet_select(spread, packet_zero, broken), doubt + at);
    row_store(packet_select(found.x, none, broken), irradiance_row(irradiance, 0, params.stride), at);
    row_store(packet_select(found.y, none, broken), irradiance_row(irradiance, 1, params.stride), at);
    row_store(packet_select(found.z, none, broken), irradiance_row(irradiance, 2, params.stride), at);
    if (!params.more) return;
    found = cache_light(&share, more, tree.stride);
    row_store(packet_select(found.x, none, broken), irradiance_row(of_more, 0, params.stride), at);
    row_store(packet_select(found.y, none, broken), irradiance_row(of_more, 1, params.stride), at);
    row_store(packet_select(found.z, none, broken), irradiance_row(of_more, 2, params.stride), at);
}
