// What the lobes of a picture's surfaces reflect of indirect light and of the sky: directions drawn
// from glTF's lobe, looked up in what the records of a pixel have around them.
//
//   L = c/K sum_k F G_1(l_k) L(l_k)                    l_k: directions of the lobe (microfacet_sample.clh)
//
// Each direction is looked up at one record, drawn by its weight (lookup.clh), in pixels about a
// quarter as large as what it stands for: larger ones blur, smaller ones are noise. c: how far the
// irradiance was corrected, in luminance (correct.cl). Of a metal's lobe the share alpha^2 counts as
// diffuse (microfacet_means). A pixel whose records were all met reflects E as a diffuse surface of the
// lobe's mean albedo does. Lobes of alpha up to params.smooth are left to reflect.cl.
//             [Krivanek05: radiance that is cached; Krivanek08: filtered importance sampling; derived]
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       radiance of its own pixels; values that are not finite are counted and left out
// Cost         a look-up, and some 250 flops and four scattered reads a direction
// SPDX-License-Identifier: MIT
#include "cache/around.clh"
#include "cache/lookup.clh"
#include "cache/pixel_lobe.clh"
#include "gloss.clh"

#define CHANGE_MOST 2.0f

CLGI_INLINE floatp gloss_along(const float4* axis, CacheVector direction) {
    return packet_dot(direction.x, direction.y, direction.z, (floatp)(packet_collect(axis, x)),
                      (floatp)(packet_collect(axis, y)), (floatp)(packet_collect(axis, z)));
}

// Radiance about unit directions, over solid angles; 0 where a record has none.
static CacheVector gloss_around(const CacheAround* of, global const View* views,
                                global const uint2* around, intp record, CacheVector direction,
                                floatp angle) {
    int lane[CLGI_WIDTH];
    packet_store(record, lane);
    float4 right[CLGI_WIDTH], up[CLGI_WIDTH], forward[CLGI_WIDTH];
    for (int k = 0; k < CLGI_WIDTH; ++k) {
        global const View* front = views + 5 * lane[k];
        right[k] = front->right;
        up[k] = front->up;
        forward[k] = front->forward;
    }
    floatp a = gloss_along(right, direction), b = gloss_along(up, direction);
    floatp c = fabs(gloss_along(forward, direction));  // beneath what bends away: mirrored
    // Faces as faces_of() numbers them; x and y on their image planes.
    intp across = fabs(a) >= fabs(b);
    floatp side = packet_select(b, a, across), other = packet_select(-a, b, across);
    floatp larger = fabs(side), half_size = packet_splat(0.5f * (float)of->size);
    intp none = (intp)(0), ahead = c >= larger;
    intp before = packet_select((intp)(3), (intp)(2), across) +
                  packet_select(none, (intp)(2), side < 0.0f);
    before = packet_select(before, none, ahead);  // half faces
    floatp x = packet_select(other / side, a / c, ahead);
    floatp y = packet_select(c / larger, b / c, ahead);
    floatp square = fma(x, x, fma(y, y, packet_splat(1.0f)));
    floatp pixels = angle * square * sqrt(square) * half_size * half_size;
    intp level = packet_select(none, (intp)(1), pixels >= 8.0f) +
                 packet_select(none, (intp)(1), pixels >= 32.0f);
    intp width = (intp)((int)of->size), height = packet_select(width / 2, width, ahead);
    x = packet_max(fma(x, half_size, half_size), packet_zero);
    y = packet_max(fma(-y, half_size, half_size), packet_zero);
    intp column = clamp(packet_int(x), none, width - 1) >> level;
    intp row = clamp(packet_int(y), none, height - 1) >> level;
    intp slot = record - packet_select((intp)((int)of->met), none, record < (int)of->seen);
    uintp place = min(as_uintp(slot), (uintp)(of->slots - 1));
    intp at = none;
    for (uint k = 0; k < AROUND_LEVELS; ++k) {
        uint size = of->size >> k;
        uintp begins = around_face(size, place, as_uintp(before));
        begins += around_first(of->slots, of->size, k);
        at = packet_select(at, as_intp(begins) + row * (int)size + column, level == (int)k);
    }
    packet_store(at, lane);
    return around_unpack(around, lane);
}

// Whose turn it is, `left` of the way through the records that have anything around them.
CLGI_INLINE intp gloss_record(const CacheShare* share, const floatp* weight, floatp left) {
    intp record = (intp)(0), found = (intp)(0);
    for (uint i = 0; i < share->count; ++i) {
        intp turn = (weight[i] > 0.0f) & (found == 0);
        record = packet_select(record, packet_load(share->record[i]), turn);
        found |= turn & (left < weight[i]);
        left -= weight[i];
    }
    return record;
}

kernel void cache_gloss(
    const CacheGlossParams        params,
    const CacheAround             of,
    const CacheTree               tree,
    global const uint*            restrict nodes,
    global const uint*            restrict lists,
    global const float*           restrict records,     // [RECORD_PLANES][tree.stride]
    global const float*           restrict light,       // [3][tree.stride] exposed lux
    global const View*            restrict views,       // five of each record
    global const uint2*           restrict around,      // [pixels of all levels] (around.cl)
    global const MaterialRecord*  restrict materials,
    global const float*           restrict planes,      // [GBUFFER_PLANES][stride]
    global const int*             restrict ids,         // [GBUFFER_ID_PLANES][stride]
    global const float*           restrict irradiance,  // [IRRADIANCE_PLANES][stride] exposed lux
    global float*                 restrict radiance,    // [RADIANCE_PLANES][stride] cd/m^2
    global uint*                  restrict non_finite)  // [1]
{
    uint first = (uint)get_global_id(0) * CLGI_WIDTH, stride = params.stride;
    if (first >= params.pixel_count) return;
    int lanes = (int)min(params.pixel_count - first, (uint)CLGI_WIDTH);
    float4 surface[CLGI_WIDTH];
    intp glossy = pixel_lobe_surfaces(planes, ids, materials, stride, first, lanes, surface);
    glossy &= (floatp)(packet_collect(surface, y)) > params.smooth;
    if (!packet_any(glossy)) return;
    PixelLobe lobe = pixel_lobe(&params, planes, ids, surface, first, glossy);
    CacheShare share;
    CacheVector places[CACHE_LISTED], normals = cache_points(planes, GBUFFER_NORMAL, stride, first);
    cache_lookup(&tree, nodes, lists, records, lobe.point, normals, CACHE_LISTED, &share, places);
    cache_carry_on(&share, places);
    CacheVector before = cache_light(&share, light, tree.stride);
    floatp all = packet_zero, one = packet_splat(1.0f), weight[CACHE_LISTED];
    for (uint i = 0; i < share.count; ++i) {
        intp record = packet_load(share.record[i]);
        intp met = (record >= (int)of.seen) & (record < (int)(of.seen + of.met));
        weight[i] = packet_select(share.weight[i], packet_zero, met);
        all += weight[i];
    }
    intp some = glossy & (all > 0.0f);
    CacheVector sum = {packet_zero, packet_zero, packet_zero};
    for (uint n = 0; packet_any(some) && n < params.directions; ++n) {
        CacheVector numbers = gloss_numbers(first, params.first_direction + n), direction, factor;
        floatp density = pixel_lobe_direction(&lobe, numbers, &direction, &factor);
        intp goes = some & (density > 0.0f);
        floatp angle = 1.0f / (packet_select(one, density, goes) * (float)params.shared);
        CacheVector seen = gloss_around(&of, views, around,
                                        gloss_record(&share, weight, numbers.z * all), direction,
                                        angle);
        sum.x += packet_select(packet_zero, factor.x * seen.x, goes);
        sum.y += packet_select(packet_zero, factor.y * seen.y, goes);
        sum.z += packet_select(packet_zero, factor.z * seen.z, goes);
    }
    CacheVector shown = {row_load(irradiance_row(irradiance, 0, stride), first),
                         row_load(irradiance_row(irradiance, 1, stride), first),
                         row_load(irradiance_row(irradiance, 2, stride), first)};
    floatp was = luminance(before.x, before.y, before.z);
    floatp change = luminance(shown.x, shown.y, shown.z) / packet_select(one, was, was > 0.0f);
    change = packet_min(packet_max(change, packet_zero), packet_splat(CHANGE_MOST));
    sum = cache_times(sum, packet_select(one, change, was > 0.0f) / (float)params.directions);
    if (packet_any(packet_select(glossy, (intp)(0), all > 0.0f))) {
        float4 means[CLGI_WIDTH];
        for (int k = 0; k < CLGI_WIDTH; ++k)
            means[k] = pixel_reflectance(ids, materials, stride,
                                         min(first + (uint)k, params.pixel_count - 1));
        floatp white = (floatp)(packet_collect(means, y));
        floatp tint = (floatp)(packet_collect(means, z));
        CacheVector diffuse = {fma(tint, lobe.base.x, white) * shown.x * (1.0f / CLGI_PI),
                               fma(tint, lobe.base.y, white) * shown.y * (1.0f / CLGI_PI),
                               fma(tint, lobe.base.z, white) * shown.z * (1.0f / CLGI_PI)};
        sum = cache_select(diffuse, sum, all > 0.0f);
    }
    int reflects[CLGI_WIDTH];
    float reflected[3][CLGI_WIDTH];
    packet_store(glossy, reflects);
    packet_store(sum.x, reflected[0]);
    packet_store(sum.y, reflected[1]);
    packet_store(sum.z, reflected[2]);
    for (int k = 0; k < lanes; ++k)
        for (uint c = 0; reflects[k] && c < 3; ++c)
            add_reflected(c * stride + first + k, params.exposure, reflected[c][k], radiance,
                          non_finite);
}
