// What directions of the sky say about records themselves. A hemicube looks at the sky once a pixel:
// of a small window, or a bright spot at its edge, one record sees it and the next does not. Shadow
// maps of many directions know, so the light that is shown of a record is corrected by
//
//   e = (sum m b) / M - S,   E' = E + max(0, 1 - SETTLE_DOUBT V / |e|^2) e
//   V = (sum (m b)^2 - Q |mean|^2) / M^2 (1 + 4 / n) (S + mean) / (2 mean),   mean = (sum m b) / M
//                                          [derived: as gauge.cl; from two standard errors on]
//
// b: what m directions bring to the record by their maps; S: what its hemicube sees of the sky;
// M, Q, n as gauge.cl has them, but of each set of directions once; squares of luminances. The variance of what comes through a small
// window grows with its mean. By its own mean a record that few directions happen to light would be
// surer than one that many do, and all together would be too dark: so V is that of the middle between
// mean and S. While n is below SETTLE_LEAST, or no direction lights the record, V is not known well
// enough and nothing is corrected.
//
// Work size    1D, one work-item for every CLGI_WIDTH records (rounded up); any local size
// Writes       sums and settled light of its own records
// SPDX-License-Identifier: MIT
#include "clgi/shared/cache.h"
#include "finite.clh"
#include "luminance.clh"
#include "packet.clh"

#define SETTLE_DOUBT 4.0f
#define SETTLE_LEAST 12.0f

kernel void cache_settle(
    const CacheSettleParams  params,
    global const float*      restrict found,    // [3][stride] -b over params.scale, exposed lux
    global const float*      restrict base,     // [3][stride] S, with the bright parts of the sky
    global const float*      restrict bright,   // [3][stride] of base
    global const float*      restrict shown,    // [3][stride] E
    global float*            restrict sums,     // [4][stride] of m b, and of its luminance squared
    global float*            restrict settled)  // [3][stride] E'
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH, stride = params.stride;
    if (at >= params.count) return;
    floatp sum[3], off[3];
    intp broken = (intp)(0);
    for (int c = 0; c < 3; ++c) {
        sum[c] = packet_load(found + c * stride + at) * -params.scale;
        broken |= as_intp(packet_magnitude(sum[c])) >= (int)NOT_FINITE;
    }
    for (int c = 0; c < 3; ++c) sum[c] = packet_select(sum[c], packet_zero, broken);
    floatp one = luminance(sum[0], sum[1], sum[2]);
    floatp square = fma(one, one, packet_load(sums + 3 * stride + at));
    packet_store(square, sums + 3 * stride + at);
    for (int c = 0; c < 3; ++c) {
        sum[c] += packet_load(sums + c * stride + at);
        packet_store(sum[c], sums + c * stride + at);
        off[c] = sum[c] / params.total -
                 (packet_load(base + c * stride + at) - packet_load(bright + c * stride + at));
    }
    float all = params.total * params.total;
    floatp mean = luminance(sum[0], sum[1], sum[2]) / params.total;
    floatp noise = (square - params.squares * mean * mean) * (1.0f / all) *
                   (1.0f + 4.0f * params.squares / all);
    floatp e = luminance(off[0], off[1], off[2]);
    intp lit = mean > 0.0f;
    floatp own = packet_select(packet_splat(1.0f), mean, lit);
    noise *= packet_select(packet_zero, 1.0f - 0.5f * e / own, lit);
    floatp needed = SETTLE_DOUBT * packet_max(noise, packet_zero);
    intp sure = lit & (e * e > needed);
    if (SETTLE_LEAST * params.squares > all) sure = (intp)(0);
    floatp share = packet_select(packet_zero, 1.0f - needed / (e * e), sure);
    for (int c = 0; c < 3; ++c)
        packet_store(fma(share, off[c], packet_load(shown + c * stride + at)),
                     settled + c * stride + at);
}
