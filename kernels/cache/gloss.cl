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
// Cost         a look-up, and some 250 flops and two scattered reads a direction
// SPDX-License-Identifier: MIT
#include "cache/around.clh"
#include "cache/lookup.clh"
#include "cache/pixel_lobe.clh"
#include "gloss.clh"

#define CHANGE_MOST 2.0f

// Radiance about a unit direction, over a solid angle; 0 where the record has none.
static float3 gloss_around(const CacheAround* of, global const View* views,
                           global const uint2* around, uint record, float3 direction, float angle) {
    global const View* front = views + 5 * record;
    float a = dot(direction, front->right.xyz), b = dot(direction, front->up.xyz);
    float c = fabs(dot(direction, front->forward.xyz));  // beneath a surface that bends away: mirrored
    // Faces as faces_of() numbers them; x and y on their image planes.
    int across = fabs(a) >= fabs(b);
    float side = across ? a : b, larger = fabs(side), other = across ? b : -a;
    uint face = c >= larger ? 0 : (across ? 1u : 2u) + (side < 0.0f ? 2u : 0u);
    float x = face == 0 ? a / c : other / side, y = face == 0 ? b / c : c / larger;
    float square = fma(x, x, fma(y, y, 1.0f)), half_size = 0.5f * (float)of->size;
    float pixels = angle * square * sqrt(square) * half_size * half_size;
    uint level = pixels < 8.0f ? 0 : pixels < 32.0f ? 1 : 2;
    uint width = of->size, height = face == 0 ? width : width / 2;
    uint column = min((uint)fmax(fma(x, half_size, half_size), 0.0f), width - 1) >> level;
    uint row = min((uint)fmax((1.0f - y) * half_size, 0.0f), height - 1) >> level;
    uint slot = record < of->seen ? record : record - of->met;
    return around_unpack(
        around[around_face(of, slot, face, level) + row * (width >> level) + column]);
}

// Whose turn it is, `left` of the way through the records that have anything around them.
CLGI_INLINE uint gloss_record(const CacheShare* share, const float weight[CACHE_LISTED][CLGI_WIDTH],
                              float left, int lane) {
    uint record = 0;
    for (uint i = 0; i < share->count; ++i) {
        if (!(weight[i][lane] > 0.0f)) continue;
        record = (uint)share->record[i][lane];
        if (left < weight[i][lane]) break;
        left -= weight[i][lane];
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
    int lanes = (int)min(params.pixel_count - first, (uint)CLGI_WIDTH), glossy[CLGI_WIDTH], any = 0;
    for (int k = 0; k < lanes; ++k) {
        float3 normal = gbuffer_load3(planes, GBUFFER_NORMAL, stride, first + k);
        float4 surface = pixel_surface(ids, materials, stride, first + k);
        glossy[k] = dot(normal, normal) > 0.0f && surface.x + surface.z + surface.w > 0.0f &&
                    surface.y > params.smooth;
        any |= glossy[k];
    }
    if (!any) return;
    CacheVector points = cache_points(planes, GBUFFER_POSITION, stride, first);
    CacheVector normals = cache_points(planes, GBUFFER_NORMAL, stride, first);
    CacheShare share;
    CacheVector places[CACHE_LISTED];
    cache_lookup(&tree, nodes, lists, records, points, normals, CACHE_LISTED, &share, places);
    cache_carry_on(&share, places);
    CacheVector before = cache_light(&share, light, tree.stride);
    floatp all = packet_zero;
    float weight[CACHE_LISTED][CLGI_WIDTH], sums[CLGI_WIDTH], was[CLGI_WIDTH];
    for (uint i = 0; i < share.count; ++i) {
        intp record = packet_load(share.record[i]);
        intp met = (record >= (int)of.seen) & (record < (int)(of.seen + of.met));
        floatp has = packet_select(share.weight[i], packet_zero, met);
        packet_store(has, weight[i]);
        all += has;
    }
    packet_store(all, sums);
    packet_store(luminance(before.x, before.y, before.z), was);

    for (int k = 0; k < lanes; ++k) {
        if (!glossy[k]) continue;
        uint pixel = first + k;
        PixelLobe lobe = pixel_lobe(&params, planes, ids, materials, pixel);
        float3 shown;
        shown.x = row_load_one(irradiance_row(irradiance, 0, stride), pixel);
        shown.y = row_load_one(irradiance_row(irradiance, 1, stride), pixel);
        shown.z = row_load_one(irradiance_row(irradiance, 2, stride), pixel);
        float3 sum = (float3)(0.0f);
        for (uint n = 0; sums[k] > 0.0f && n < params.directions; ++n) {
            float3 numbers = gloss_numbers(pixel, params.first_direction + n);
            float3 direction, factor;
            float density = pixel_lobe_direction(&lobe, numbers, &direction, &factor);
            if (!(density > 0.0f)) continue;
            sum += factor * gloss_around(&of, views, around,
                                         gloss_record(&share, weight, numbers.z * sums[k], k),
                                         direction, 1.0f / (density * (float)params.shared));
        }
        float is = luminance(shown.x, shown.y, shown.z);
        sum *= (was[k] > 0.0f ? clamp(is / was[k], 0.0f, CHANGE_MOST) : 1.0f) / (float)params.directions;
        if (!(sums[k] > 0.0f)) {
            float4 means = pixel_reflectance(ids, materials, stride, pixel);
            sum = (means.y + means.z * lobe.base) * shown * (1.0f / CLGI_PI);
        }
        add_reflected(pixel, params.exposure, sum.x, radiance, non_finite);
        add_reflected(stride + pixel, params.exposure, sum.y, radiance, non_finite);
        add_reflected(2 * stride + pixel, params.exposure, sum.z, radiance, non_finite);
    }
}
