// The light of an irradiance volume at points of surfaces that an atlas has no place for, such as
// those of what moves.
// [derived: Greger98, interpolation; Majercik19, moment-based filtered queries]
//
//   E(x, n) = sum_k t_k b_k v_k E_k(n) / sum_k t_k b_k v_k,   k: the points of the eight cubes
//                                                              around x that have light
//   E_k(n) = max(0, sum_i w(n . n_i) E_k(n_i))                         (clgi/shared/volume.h)
//   b_k = ((1 + n . to_k) / 2)^2 + VOLUME_BEHIND,   to_k: the direction from y to point k
//   v_k = c_k^3,   c_k = 1 where d_k <= m, else s^2 / (s^2 + (d_k - m)^2)
//
// t: trilinear in x. y = x + VOLUME_LIFT n, off its own surface. d_k: distance of y from the point.
// m, s^2: mean and variance of the distances of surfaces that the point sees along -to_k, so v_k is
// Chebyshev's bound of the share of them beyond y. A sum of no weights is no light.
// w comes from a spherical design.
//
// Unlike paper: points in solid matter have no light, and weights below 0.2 are not made smaller.
//
// Work size    1D, one work-item a point of a surface; any local size; tail guarded
// Writes       the irradiance of its own point where a triangle is seen that no chart has, which is
//              not finite where its place, its normal or the light is not, for the passes that
//              count it
// Cost         some 140 flops, and for each point of the grid 200 more and 48 floats read
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/volume.h"
#include "finite.clh"
#include "planes.clh"

#define VOLUME_BEHIND 0.2f
#define VOLUME_LIFT 0.05f  // spacings
// Squared spacings, the least variance: surfaces do not shadow themselves by rounding.
#define VOLUME_VARIANCE 1e-4f

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

// Mean distance, and mean squared distance, of surfaces in a direction, interpolated between the
// four texels around it.
static float2 volume_distances(global const float* map, float3 direction) {
    float3 size = fabs(direction);
    float2 at = direction.xy / fmax(size.x + size.y + size.z, 1e-20f);
    if (direction.z < 0.0f) at = copysign(1.0f - fabs(at.yx), at);
    at = fma(at, 0.5f * VOLUME_SIDE, 0.5f * VOLUME_SIDE + 0.5f);
    float2 low = floor(at), part = at - low;
    map += 2 * ((int)low.y * VOLUME_ROW + (int)low.x);
    float4 column = mix(vload4(0, map), vload4(0, map + 2 * VOLUME_ROW), part.y);
    return mix(column.xy, column.zw, part.x);
}

// b v of the header; to: from the place to the point, spacings.
static float volume_counts(float3 to, float3 normal, global const float* map) {
    float distance = length(to);
    float3 direction = to / fmax(distance, 1e-20f);
    float faces = fma(0.5f, dot(direction, normal), 0.5f);
    float2 surfaces = volume_distances(map, -direction);
    float beyond = fmax(fmin(distance, VOLUME_RANGE) - surfaces.x, 0.0f);
    float variance = fmax(fma(-surfaces.x, surfaces.x, surfaces.y), VOLUME_VARIANCE);
    float seen = variance / fma(beyond, beyond, variance);
    return fma(faces, faces, VOLUME_BEHIND) * (seen * seen * seen);
}

kernel void atlas_volume(
    const VolumeParams    params,
    global const float*   restrict planes,      // [GBUFFER_PLANES][stride]
    global const int*     restrict ids,         // [GBUFFER_ID_PLANES][stride]
    global const uint2*   restrict charts,      // [triangle_count] page and chart; ATLAS_NONE
    global const float4*  restrict places,      // [layers][rows][columns] IrradianceVolume::places
    global const float*   restrict distances,   // [open_count][VOLUME_TEXELS][2] mean, mean square
    global const float*   restrict light,       // [3][light_stride] lux, exposed; from params.first
                                                // on [open_count][VOLUME_DIRECTIONS]
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
    float3 at_grid = (point - params.origin.xyz) * params.origin.w;
    if (!is_finite3(at_grid) || !is_finite3(normal)) {
        for (int c = 0; c < 3; ++c)
            row_store_one(as_float(0x7fc00000u), irradiance_row(irradiance, c, stride), at);
        return;
    }
    float weights[VOLUME_DIRECTIONS];
    volume_weights(normal, weights);
    float3 most = (float3)(params.columns, params.rows, params.layers) - 1.0f;
    float3 lifted = fma(normal, VOLUME_LIFT, at_grid);
    float3 place = clamp(at_grid, 0.0f, most);
    float3 corner = min(floor(place), max(most - 1.0f, 0.0f));
    float3 part = place - corner;
    float sum[3] = {0.0f, 0.0f, 0.0f}, all = 0.0f;
    for (int tap = 0; tap < 8; ++tap) {
        float3 far = (float3)(tap & 1, tap >> 1 & 1, tap >> 2);
        float3 t = select(1.0f - part, part, far > 0.0f);
        float share = t.x * t.y * t.z;
        if (!(share > 0.0f)) continue;
        uint3 cell = convert_uint3(corner + far);
        float4 open = places[(cell.z * params.rows + cell.y) * params.columns + cell.x];
        if (open.w < 0.0f) continue;
        uint number = (uint)open.w;
        float counts = share * volume_counts(open.xyz - lifted, normal,
                                             distances + 2 * VOLUME_TEXELS * number);
        all += counts;
        for (int c = 0; c < 3; ++c) {
            global const float* values =
                light + c * params.light_stride + params.first + VOLUME_DIRECTIONS * number;
            float4 four = (float4)(0.0f);
            for (int i = 0; i < VOLUME_DIRECTIONS / 4; ++i)
                four = fma(vload4(i, weights), vload4(i, values), four);
            float lit = (four.x + four.y) + (four.z + four.w);
            sum[c] = fma(counts, is_finite(lit) ? fmax(lit, 0.0f) : lit, sum[c]);
        }
    }
    for (int c = 0; c < 3; ++c) {
        float value = all > 0.0f ? sum[c] / all : 0.0f;
        row_store_one(value, irradiance_row(irradiance, c, stride), at);
    }
}
