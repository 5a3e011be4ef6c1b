// Corrects the light that records bring to the pixels of a picture by what directions of the sky say,
// as far as these are trusted (gauge.cl): by shares of the blocks around, linear between their middles.
//
//   E' = E + share (sum m d) / M           [derived: control variate with a fitted factor]
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       irradiance of its own pixel
// SPDX-License-Identifier: MIT
#include "clgi/shared/cache.h"
#include "planes.clh"

kernel void cache_correct(
    const CacheCorrectParams  params,
    global const float*       restrict sums,        // [5][stride] (gauge.cl)
    global const float*       restrict shares,      // [blocks down][blocks across]
    global float*             restrict irradiance)  // [IRRADIANCE_PLANES][stride] exposed lux
{
    uint at = (uint)get_global_id(0), stride = params.stride;
    if (at >= params.width * params.height) return;
    uint across = cache_blocks(params.width), down = cache_blocks(params.height);
    float x = ((float)(at % params.width) + 0.5f) / (float)CACHE_BLOCK - 0.5f;
    float y = ((float)(at / params.width) + 0.5f) / (float)CACHE_BLOCK - 0.5f;
    x = clamp(x, 0.0f, (float)(across - 1));
    y = clamp(y, 0.0f, (float)(down - 1));
    uint left = (uint)x, top = (uint)y;
    uint right = min(left + 1, across - 1), bottom = min(top + 1, down - 1);
    float to_right = x - (float)left, to_bottom = y - (float)top;
    float above = mix(shares[top * across + left], shares[top * across + right], to_right);
    float below = mix(shares[bottom * across + left], shares[bottom * across + right], to_right);
    float share = mix(above, below, to_bottom) / params.total;
    for (uint c = 0; c < 3; ++c) {
        Row row = irradiance_row(irradiance, c, stride);
        row_store_one(fma(share, sums[c * stride + at], row_load_one(row, at)), row, at);
    }
}
