// Which texels the VPLs of a batch see: a bit for every pair, which stays true whatever the light.
// [derived: Schaerfig16, section 4]; see.clh has what it does for a pair, and its cost.
//
// Work size     1D, one work-item for every CLGI_WIDTH texels; any local size; tail guarded
// Writes        its own texels' bytes, one for every SEEN_VPLS shooters
// SPDX-License-Identifier: MIT
#include "atlas/see.clh"

kernel void atlas_see(
    const SeeParams     params,
    global const View*  restrict views,   // [5 * shooter_count]
    global const uint*  restrict depth,   // [pixels of the views]
    global const float* restrict texels,  // [>= GBUFFER_GEOMETRIC + 3][stride]
    global uchar*       restrict seen)    // [rows][stride]
{
    uint at = params.first_texel + (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.texel_count) return;
    uint stride = params.stride;
    global const float* from = texels + at;
    floatp px, py, pz;
    packet_load3(from, stride, &px, &py, &pz);
    from += GBUFFER_GEOMETRIC * stride;
    floatp gx, gy, gz;
    packet_load3(from, stride, &gx, &gy, &gz);
    global uchar* row = seen + (ulong)params.first_row * stride + at;
    for (uint first = 0; first < params.shooter_count; first += SEEN_VPLS, row += stride) {
        uint last = min(first + SEEN_VPLS, params.shooter_count);
        intp bits = see_bits(views, depth, first, last, SEE_ALL, px, py, pz, gx, gy, gz);
        packet_store_flags(bits, row);
    }
}
