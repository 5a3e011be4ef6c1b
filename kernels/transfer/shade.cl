// What arrives at receivers: the inner product of transfer and light [Kautz04, Eq. 2], a channel each.
//
// Both are cut at some band, so the product may be negative where little arrives; with SHADE_CLAMP it
// is 0 there. Packets with a number that is not finite are counted and stay as they are, clamped or
// not.                                               [derived: a clamp would turn NaN into darkness]
//
// Cost         3 terms multiply-adds and 4 terms + 12 bytes a receiver
// Work size    1D, one work-item a packet of receivers; any local size; tail guarded
// Writes       irradiance of its receivers; adds to non_finite
// SPDX-License-Identifier: MIT
#include "clgi/shared/masks.h"
#include "transfer/sh.clh"

kernel void transfer_shade(
    const ShadeParams     params,
    global const float*   restrict transfer,    // [terms][stride] sr
    global const float4*  restrict light,       // [terms] rgb: exposed cd/m^2
    global float*         restrict irradiance,  // [3][stride] exposed lux
    global uint*          restrict non_finite)  // [1]
{
    uint first = (uint)get_global_id(0) * CLGI_WIDTH;
    if (first >= params.receiver_count) return;
    floatp sum[3] = {packet_zero, packet_zero, packet_zero};
    for (int i = 0; i < SH_TERMS; ++i) {
        floatp value = packet_load(transfer + (uint)i * params.stride + first);
        float4 c = light[i];
        sum[0] = fma(value, packet_splat(c.x), sum[0]);
        sum[1] = fma(value, packet_splat(c.y), sum[1]);
        sum[2] = fma(value, packet_splat(c.z), sum[2]);
    }
    // Lanes behind the last receiver hold no numbers of anyone.
    intp ours = as_intp((uintp)(first)) + packet_lanes < (intp)((int)params.receiver_count);
    intp lost = (intp)(0);
    for (int c = 0; c < 3; ++c) {
        intp finite = as_intp(packet_magnitude(sum[c])) < (intp)(NOT_FINITE);
        lost |= ours & (finite == 0);
        if (params.flags & SHADE_CLAMP) {
            // By bits: fast math takes every number for finite.
            intp negative = as_intp(packet_bits(sum[c])) < (intp)(0);
            sum[c] = packet_select(sum[c], packet_zero, negative & finite);
        }
        packet_store(sum[c], irradiance + (uint)c * params.stride + first);
    }
    if (packet_any(lost)) atomic_inc(non_finite);
}
