// The light of an atlas at points of surfaces, such as the pixels of a picture.
//
//   E = sum_k w_k E_k / sum_k w_k,   k: those of the four nearest texels that the point's chart has
//
// w: bilinear. Texels that no chart covers, and those of other charts, are left out, so that nothing
// bleeds over the border of a chart. A chart that has none of the four, which only a UV set can
// bring about, takes those of others, as any sampler would.
//          [Schaerfig16, section 4: the atlas is drawn as a texture; derived: bilinear interpolation]
//
// Work size    1D, one work-item a point; any local size; tail guarded
// Writes       the irradiance of its own point, 0 where no triangle or no chart is. What is not
//              finite stays so, for the passes that count it
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "clgi/shared/gbuffer.h"
#include "finite.clh"
#include "gbuffer/barycentric.clh"
#include "planes.clh"

// Where a point of a triangle lies in its page, texels.
static float2 show_place(float3 point, uint4 corners, global const float4* positions,
                         global const float2* texels) {
    float3 first = positions[corners.x].xyz;
    float3 e1 = positions[corners.y].xyz - first;
    float3 e2 = positions[corners.z].xyz - first;
    float2 b = barycentric(point - first, e1, e2, cross(e1, e2));
    return texels[0] + b.x * (texels[1] - texels[0]) + b.y * (texels[2] - texels[0]);
}

kernel void atlas_show(
    const ShowParams       params,
    global const uint4*    restrict triangles,   // [triangle_count] of the scene
    global const float4*   restrict positions,   // of its vertices, local frame
    global const float*    restrict planes,      // [GBUFFER_PLANES][stride]
    global const int*      restrict ids,         // [GBUFFER_ID_PLANES][stride]
    global const float2*   restrict corners,     // [3 * triangle_count] texels of the page
    global const uint2*    restrict charts,      // [triangle_count] page and chart; ATLAS_NONE
    global const uint*     restrict map,         // [pages][size][size] which texel; ATLAS_NONE
    global const uint*     restrict chart_of,    // [texel_count]
    global const float*    restrict light,       // [3][texel_stride] lux, exposed
    global float*          restrict irradiance)  // [IRRADIANCE_PLANES][stride] the same
{
    uint at = (uint)get_global_id(0);
    if (at >= params.point_count) return;
    uint stride = params.stride;
    float sum[3] = {0.0f, 0.0f, 0.0f}, other[3] = {0.0f, 0.0f, 0.0f};
    float weight = 0.0f, other_weight = 0.0f;
    int triangle = ids[GBUFFER_TRIANGLE * stride + at];
    uint2 chart = (uint2)(ATLAS_NONE);
    if (triangle >= 0 && triangle < (int)params.triangle_count) chart = charts[triangle];
    if (chart.x < params.pages) {
        float3 point = gbuffer_load3(planes, GBUFFER_POSITION, stride, at);
        float2 place = show_place(point, triangles[triangle], positions, corners + 3 * triangle);
        if (!is_finite3(point)) {
            for (int c = 0; c < 3; ++c) sum[c] = as_float(0x7fc00000u);
            weight = 1.0f;
            place = (float2)(0.0f);
        }
        place -= 0.5f;
        float2 corner = floor(place);
        float2 part = place - corner;
        int last = (int)params.size - 1;
        for (int tap = 0; tap < 4; ++tap) {
            int right = tap & 1, below = tap >> 1;
            int column = clamp((int)corner.x + right, 0, last);
            int row = clamp((int)corner.y + below, 0, last);
            float w = (right ? part.x : 1.0f - part.x) * (below ? part.y : 1.0f - part.y);
            uint texel = map[(chart.x * params.size + (uint)row) * params.size + (uint)column];
            if (texel >= params.texel_count || !(w > 0.0f)) continue;
            if (chart_of[texel] == chart.y) {
                weight += w;
                for (int c = 0; c < 3; ++c)
                    sum[c] = fma(w, light[c * params.texel_stride + texel], sum[c]);
            } else {
                other_weight += w;
                for (int c = 0; c < 3; ++c)
                    other[c] = fma(w, light[c * params.texel_stride + texel], other[c]);
            }
        }
    }
    for (int c = 0; c < 3; ++c) {
        float value = weight > 0.0f         ? sum[c] / weight
                      : other_weight > 0.0f ? other[c] / other_weight
                                            : 0.0f;
        row_store_one(value, irradiance_row(irradiance, c, stride), at);
    }
}
