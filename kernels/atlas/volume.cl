// The light of an irradiance volume at points of surfaces that an atlas has no place for, such as
// those of what moves.
//
//   E(x, n) = sum_k s_k t_k E_k(n) / sum_k s_k t_k,   k: the eight nearest points of the grid
//   E_k(n) = max(0, sum_i w(n . n_i) E_k(n_i))                       (clgi/shared/volume.h)
//   s_k = min(1, a_k / (VOLUME_DARK sum_j t_j a_j)),  a_k = sum_i E_k(n_i), all channels
//
// t: trilinear. Points that are much darker than what is interpolated lie within walls, and have
// little say; s is continuous over the borders of cubes.
//                                                               [Greger98; derived: w, s]
//
// Work size    1D, one work-item a point of a surface; any local size; tail guarded
// Writes       the irradiance of its own point where a triangle is seen that no chart has, which is
//              not finite where its place, its normal or the light is not, for the passes that
//              count it
// Cost         some 140 flops, and for each point of the grid 120 more and 36 floats read
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/volume.h"
#include "finite.clh"
#include "planes.clh"

#define VOLUME_DARK 0.05f

// w of the twelve directions; n: unit.
static void volume_weights(float3 n, float weights[VOLUME_DIRECTIONS]) {
    float along[5] = {n.x, n.y, n.z, n.x, n.y};
    for (int i = 0; i < VOLUME_DIRECTIONS; ++i) {
        int zero = i / 4;
        float a = VOLUME_SHORT * along[zero + 1], b = VOLUME_LONG * along[zero + 2];
        float c = (i & 1 ? a : -a) + (i & 2 ? b : -b);
        weights[i] = (fma(c, fma(7.5f, c, 3.0f), -1.5f)) / 12.0f;
    }
}

kernel void atlas_volume(
    const VolumeParams    params,
    global const float*   restrict planes,      // [GBUFFER_PLANES][stride]
    global const int*     restrict ids,         // [GBUFFER_ID_PLANES][stride]
    global const uint2*   restrict charts,      // [triangle_count] page and chart; ATLAS_NONE
    global const float*   restrict light,       // [3][light_stride] lux, exposed; from params.first
                                                // on [layers][rows][columns][VOLUME_DIRECTIONS]
    global float*         restrict irradiance)  // [IRRADIANCE_PLANES][stride] the same
{
    uint at = (uint)get_global_id(0);
    if (at >= params.point_count) return;
    uint stride = params.stride;
    int triangle = ids[GBUFFER_TRIANGLE * stride + at];
    if (triangle < 0 || triangle >= (int)params.triangle_count) return;
    if (charts[triangle].x != ATLAS_NONE) return;
    float3 point = gbuffer_load3(planes, GBUFFER_POSITION, stride, at);
    float3 normal = gbuffer_load3(planes, GBUFFER_NORMAL, stride, at);
    if (!is_finite3(point) || !is_finite3(normal)) {
        for (int c = 0; c < 3; ++c)
            row_store_one(as_float(0x7fc00000u), irradiance_row(irradiance, c, stride), at);
        return;
    }
    float weights[VOLUME_DIRECTIONS];
    volume_weights(normal, weights);
    float3 most = (float3)(params.columns, params.rows, params.layers) - 1.0f;
    float3 place = clamp((point - params.origin.xyz) * params.origin.w, 0.0f, most);
    float3 corner = min(floor(place), max(most - 1.0f, 0.0f));
    float3 part = place - corner;
    float share[8], arrives[8], lit[8][3], mean = 0.0f;
    for (int tap = 0; tap < 8; ++tap) {
        float3 far = (float3)(tap & 1, tap >> 1 & 1, tap >> 2);
        float3 t = select(1.0f - part, part, far > 0.0f);
        share[tap] = t.x * t.y * t.z;
        if (!(share[tap] > 0.0f)) continue;
        uint3 cell = convert_uint3(corner + far);
        uint from = params.first +
                    VOLUME_DIRECTIONS *
                        ((cell.z * params.rows + cell.y) * params.columns + cell.x);
        float4 size = (float4)(0.0f);
        for (int c = 0; c < 3; ++c) {
            global const float* values = light + c * params.light_stride + from;
            float4 sum = (float4)(0.0f);
            for (int i = 0; i < VOLUME_DIRECTIONS / 4; ++i) {
                float4 value = vload4(i, values);
                sum = fma(vload4(i, weights), value, sum);
                size += fabs(value);
            }
            lit[tap][c] = fmax((sum.x + sum.y) + (sum.z + sum.w), 0.0f);
        }
        arrives[tap] = (size.x + size.y) + (size.z + size.w);
        mean = fma(share[tap], arrives[tap], mean);
    }
    float sum[3] = {0.0f, 0.0f, 0.0f}, all = 0.0f;
    for (int tap = 0; tap < 8 && mean > 0.0f; ++tap) {
        if (!(share[tap] > 0.0f)) continue;
        float counts = share[tap] * fmin(arrives[tap] / (VOLUME_DARK * mean), 1.0f);
        all += counts;
        for (int c = 0; c < 3; ++c) sum[c] = fma(counts, lit[tap][c], sum[c]);
    }
    for (int c = 0; c < 3; ++c) {
        float value = all > 0.0f ? sum[c] / all : 0.0f;
        if (!is_finite(mean)) value = mean;
        row_store_one(value, irradiance_row(irradiance, c, stride), at);
    }
}
