// Which texels the VPLs of a batch see: a bit for every pair, which stays true whatever the light.
//
// Every texel looks up the VPL's depth maps: no seams, no extrapolation, and no two writers of a
// texel. The paper projects each VPL's picture into the atlas.  [derived: Schaerfig16, section 4]
//
// Work size     1D, one work-item for every CLGI_WIDTH texels; any local size; tail guarded
// Writes        its own texels' bytes, one for every SEEN_VPLS shooters
// Cost          15 flops a pair; 60 more and a look-up if it faces each other; 60 more and two look-ups
//               if the pixel does not hide it; 1 bit written
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "clgi/shared/vpl.h"
#include "vpl/hemicube.clh"

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
        intp bits = (intp)(0);
        uint last = min(first + SEEN_VPLS, params.shooter_count);
        for (uint s = first; s < last; ++s) {
            Hemicube cube = hemicube_of(views + 5 * s);
            floatp dx = px - packet_splat(cube.eye.x);
            floatp dy = py - packet_splat(cube.eye.y);
            floatp dz = pz - packet_splat(cube.eye.z);
            intp wanted = (packet_dot(dx, dy, dz, gx, gy, gz) < 0.0f) &
                          (packet_dot(dx, dy, dz, packet_splat(cube.c.x), packet_splat(cube.c.y),
                                      packet_splat(cube.c.z)) > 0.0f);
            if (!packet_any(wanted)) continue;
            intp sees = hemicube_sees(&cube, depth, dx, dy, dz, gx, gy, gz, wanted);
            bits |= packet_select((intp)(0), (intp)(1 << (s - first)), sees);
        }
        packet_store_flags(bits, row);
    }
}
