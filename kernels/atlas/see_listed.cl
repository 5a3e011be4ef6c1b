// Which texels of a list the VPLs of a batch see: the first of two steps, before see_blocks.cl.
//
// The list has the corners of all blocks, and every texel that is in no block.
// [Schaerfig16, section 6.2: texels of low resolution come first]
//
// Work size     1D, one work-item for every CLGI_WIDTH listed texels; any local size; tail guarded
// Writes        the list's bytes, one for every SEEN_VPLS shooters; the same to the places of the
//               first `unblocked` texels, which see_blocks leaves alone
// Cost          as see.clh; 1 byte more written for a texel that is in no block
// SPDX-License-Identifier: MIT
#include "atlas/see.clh"

kernel void atlas_see_listed(
    const BlockParams   params,
    global const View*  restrict views,        // [5 * shooter_count]
    global const uint*  restrict depth,        // [pixels of the views]
    global const float* restrict listed,       // [>= GBUFFER_GEOMETRIC + 3][listed_stride]
    global const uint*  restrict places,       // [unblocked] texels
    global uchar*       restrict listed_seen,  // [rows of the batch][listed_stride]
    global uchar*       restrict seen)         // [rows][stride]
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.listed_count) return;
    uint stride = params.listed_stride;
    global const float* from = listed + at;
    floatp px, py, pz;
    packet_load3(from, stride, &px, &py, &pz);
    from += GBUFFER_GEOMETRIC * stride;
    floatp gx, gy, gz;
    packet_load3(from, stride, &gx, &gy, &gz);
    uint alone = at < params.unblocked ? min(params.unblocked - at, (uint)CLGI_WIDTH) : 0;
    global uchar* listed_row = listed_seen + at;
    global uchar* row = seen + (ulong)params.first_row * params.stride;
    for (uint first = 0; first < params.shooter_count; first += SEEN_VPLS) {
        uint last = min(first + SEEN_VPLS, params.shooter_count);
        intp bits = see_bits(views, depth, first, last, SEE_ALL, px, py, pz, gx, gy, gz);
        packet_store_flags(bits, listed_row);
        int lanes[CLGI_WIDTH];
        packet_store(bits, lanes);
        for (uint k = 0; k < alone; ++k) row[places[at + k]] = (uchar)lanes[k];
        listed_row += stride;
        row += params.stride;
    }
}
