// VPLs stand off the edges of their patches, so a texel in a corner sees the strip beside it filled
// by none. What fills the rest of its hemisphere stands for that strip too. Discs also stand out
// over the edges of their patches, and form factors that sum up to more than 1 are too large:
//
//   I = G clamp(h / S, min(1, 1 / S), COMPLETE_MOST),   S = sum_i F_i,   G: gathered
//                                                        [derived: sum of form factors, h: nearest.cl]
//
// In a closed scene h is 1 and the sum of all form factors becomes what it has to be. Where h is
// less, it is another place's, and lowers nothing.
//
// Work size     1D, one work-item for every CLGI_WIDTH texels; any local size; tail guarded
// Writes        its own texels; packets with numbers that are not finite are counted
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "packet.clh"

// Gaps of centimetres are filled by what the sample points do not resolve: more would be a guess.
#define COMPLETE_MOST 1.5f

kernel void atlas_complete(
    const FillParams       params,
    global const float*    restrict reach,       // [stride]
    global const float*    restrict filled,      // [stride]
    global const float*    restrict gathered,    // [3][stride] lux, exposed
    global float*          restrict irradiance,  // [3][stride] lux, exposed
    volatile global uint*  restrict non_finite)  // [1]
{
    uint at = params.first_texel + (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.texel_count) return;
    floatp one = packet_splat(1.0f);
    floatp sum = packet_load(filled + at);
    floatp per_sum = one / packet_select(one, sum, sum > 0.0f);
    floatp factor = packet_load(reach + at) * per_sum;
    factor = packet_min(packet_max(factor, packet_min(one, per_sum)), packet_splat(COMPLETE_MOST));
    uintp worst = (uintp)(0);
    for (int c = 0; c < 3; ++c) {
        uint place = c * params.stride + at;
        floatp value = packet_load(gathered + place) * factor;
        worst = max(worst, packet_magnitude(value));
        // Light that was taken away again leaves residues of rounding. By bits: what is not finite
        // stays so.
        intp negative = (as_intp(packet_bits(value)) < 0) &
                        (as_intp(packet_magnitude(value)) < NOT_FINITE);
        value = packet_select(value, packet_zero, negative);
        packet_store(value, irradiance + place);
    }
    intp bad = (as_intp(worst) >= NOT_FINITE) & ((int)at + packet_lanes < (int)params.texel_count);
    if (packet_any(bad)) atomic_inc(non_finite);
}
