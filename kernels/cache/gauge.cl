// How far to trust what the directions of the sky say about the pixels of a block, against what the
// records between them say. Corrections d of m directions each have the right mean, but are noisy
// while there are few.    [derived: the linear estimate of least mean square error; 4: measured]
//
//   B = sum over pixels ((sum m d)^2 - sum (m d)^2) / (M^2 - Q)     the mean's square, without noise
//   V = sum over pixels (sum (m d)^2 - Q B) / M^2                   the noise of the mean
//   share = 1 - V (1 + 4 / n) / B, 0 for one correction and where it were less
//
// d: luminance, M = sum m, Q = sum m^2, n = M^2 / Q: how many corrections of one size are worth as much.
// Samples that have the same directions are one correction, of their sums of m d and of m: their noise
// is one.
// The linear estimate of least mean square error has B / (B + V), which trusts too much while n is
// small (docs/results/irradiance-cache.md).
//
// What lies outside the directions' shadow maps has no correction.
//
// Work size    1D, one work-item a block of CACHE_BLOCK x CACHE_BLOCK pixels; any local size; tail
//              guarded
// Writes       sums of its own pixels, its own share
// SPDX-License-Identifier: MIT
#include "clgi/shared/cache.h"
#include "finite.clh"
#include "luminance.clh"
#include "planes.clh"

kernel void cache_gauge(
    const CacheCorrectParams  params,
    global const float*       restrict planes,  // [>= POINT_PLANES][stride]
    global const float*       restrict found,   // [3][stride] d of this sample, exposed lux
    global float*             restrict sums,    // [5][stride] of m d, of its luminance squared,
                                               // and its luminance, of these directions
    global float*             restrict shares)  // [blocks down][blocks across]
{
    uint item = (uint)get_global_id(0), stride = params.stride;
    uint across = cache_blocks(params.width), down = cache_blocks(params.height);
    if (item >= across * down) return;
    uint left = item % across * CACHE_BLOCK, top = item / across * CACHE_BLOCK;
    uint right = min(left + CACHE_BLOCK, params.width), bottom = min(top + CACHE_BLOCK, params.height);
    float together = 0.0f, apart = 0.0f;
    for (uint y = top; y < bottom; ++y)
        for (uint x = left; x < right; ++x) {
            uint at = y * params.width + x;
            float3 d = (float3)(found[at], found[stride + at], found[2 * stride + at]);
            if (!is_finite3(d)) d = (float3)(0.0f);  // counted where it came from (lights/direct.cl)
            float3 point = gbuffer_load3(planes, GBUFFER_POSITION, stride, at);
            if (any(point < params.low.xyz || point > params.high.xyz)) d = (float3)(0.0f);
            d *= params.scale;
            float3 sum = d + (float3)(sums[at], sums[stride + at], sums[2 * stride + at]);
            float before = params.again ? sums[4 * stride + at] : 0.0f;
            float one = before + luminance(d.x, d.y, d.z), all = luminance(sum.x, sum.y, sum.z);
            float square = fma(one, one, sums[3 * stride + at] - before * before);
            sums[at] = sum.x;
            sums[stride + at] = sum.y;
            sums[2 * stride + at] = sum.z;
            sums[3 * stride + at] = square;
            sums[4 * stride + at] = one;
            together = fma(all, all, together);
            apart += square;
        }
    float all = params.total * params.total, pairs = all - params.squares;
    int some = pairs > 0.0f;
    float mean = some ? (together - apart) / pairs : 0.0f;
    float noise = (apart - params.squares * mean) / all * (1.0f + 4.0f * params.squares / all);
    some = some && mean > fmax(noise, 0.0f);
    shares[item] = some ? (mean - fmax(noise, 0.0f)) / mean : 0.0f;
}
