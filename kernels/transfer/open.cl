// What arrives where nothing blocks the light: it depends on the normal alone.
//
//   E(n) = sum over l of A_l sum over m of L_lm Y_lm(n)   [Ramamoorthi01, Eq. 8; Kautz04, section 3.2]
//
// A_l: the clamped cosine, pi, 2 pi / 3, pi / 4, 0, -pi / 24 ..., times a window. L is cut at some
// band, so the sum may be negative where little arrives; with SHADE_CLAMP it is 0 there. Normals of
// any length are made unit; where the normal is 0 there is no surface and nothing arrives. Packets
// with a number that is not finite are counted and stay as they are, clamped or not.
//                                                    [derived: a clamp would turn NaN into darkness]
//
// Cost         6 terms multiply-adds and 24 bytes a receiver (half: 12)
// Work size    1D, one work-item a packet of receivers; any local size; tail guarded
// Writes       irradiance of its receivers; adds to non_finite
// SPDX-License-Identifier: MIT
#include "clgi/shared/masks.h"
#include "planes.clh"
#include "transfer/sh.clh"

kernel void transfer_open(
    const OpenParams      params,
    global const float*   restrict planes,      // [> normal + 2][stride] of receivers or a G-buffer
    global const float4*  restrict light,       // [terms] rgb: exposed cd/m^2 sr
    global float*         restrict irradiance,  // [3][stride] exposed lux
    global uint*          restrict non_finite)  // [1]
{
    uint first = (uint)get_global_id(0) * CLGI_WIDTH;
    if (first >= params.receiver_count) return;
    floatp n[3];
    for (uint k = 0; k < 3; ++k)
        n[k] = row_load(gbuffer_row(planes, params.normal + k, params.stride), first);
    floatp square = packet_dot(n[0], n[1], n[2], n[0], n[1], n[2]);
    // By bits: fast math takes every number for finite.
    intp surface = as_intp(packet_magnitude(square)) > (intp)(0);
    floatp per_length = 1.0f / sqrt(packet_select(packet_splat(1.0f), square, surface));
    floatp y[SH_TERMS];
    sh_evaluate(n[0] * per_length, n[1] * per_length, n[2] * per_length, y);
    floatp sum[3] = {packet_zero, packet_zero, packet_zero};
#pragma unroll
    for (int l = 0; l < CLGI_SH_BANDS; ++l) {
        float cosine = params.cosine[l];
        for (int i = l * l; i < (l + 1) * (l + 1); ++i) {
            float4 c = light[i] * cosine;
            sum[0] = fma(y[i], packet_splat(c.x), sum[0]);
            sum[1] = fma(y[i], packet_splat(c.y), sum[1]);
            sum[2] = fma(y[i], packet_splat(c.z), sum[2]);
        }
    }
    // Lanes behind the last receiver hold no numbers of anyone.
    intp ours = as_intp((uintp)(first)) + packet_lanes < (intp)((int)params.receiver_count);
    intp lost = (intp)(0);
    for (int c = 0; c < 3; ++c) {
        floatp arrives = packet_select(packet_zero, sum[c], surface);
        intp finite = as_intp(packet_magnitude(arrives)) < (intp)(NOT_FINITE);
        lost |= ours & (finite == 0);
        if (params.flags & SHADE_CLAMP) {
            intp negative = as_intp(packet_bits(arrives)) < (intp)(0);
            arrives = packet_select(arrives, packet_zero, negative & finite);
        }
        row_store(arrives, irradiance_row(irradiance, c, params.stride), first);
    }
    if (packet_any(lost)) atomic_inc(non_finite);
}
