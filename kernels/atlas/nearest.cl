// The share of a texel's hemisphere that meets surfaces, taken from the nearest VPL that faces the
// same way: there it was measured (vpl/reach.cl).                    [derived: nearest neighbour]
//
// Work size     1D, one work-item for every CLGI_WIDTH texels; any local size; tail guarded
// Writes        its own texels; 0 where no VPL faces their way
// Cost          8 flops a pair, 5 more where a texel of the packet finds it nearer than all before
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/vpl.h"
#include "packet.clh"

kernel void atlas_nearest(
    const FillParams     params,
    global const float*  restrict site_planes,  // [SITE_PLANES][site_stride]
    global const float*  restrict balance,      // [BALANCE_PLANES][site_stride]
    global const float*  restrict texels,       // [>= GBUFFER_GEOMETRIC + 3][stride]
    global float*        restrict reach)        // [stride]
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
    floatp least = packet_splat(INFINITY);
    floatp found = packet_zero;
    for (uint s = 0; s < params.shooter_count; ++s) {
        global const float* site = site_planes + s;
        uint step = params.site_stride;
        floatp dx = px - packet_splat(site[0]);
        floatp dy = py - packet_splat(site[step]);
        floatp dz = pz - packet_splat(site[2 * step]);
        floatp square = packet_dot(dx, dy, dz, dx, dy, dz);
        intp nearer = square < least;
        if (!packet_any(nearer)) continue;
        floatp alike = packet_dot(gx, gy, gz, packet_splat(site[3 * step]),
                                  packet_splat(site[4 * step]), packet_splat(site[5 * step]));
        nearer &= alike > 0.5f;
        least = packet_select(least, square, nearer);
        found = packet_select(found, packet_splat(balance[BALANCE_REACH * step + s]), nearer);
    }
    packet_store(found, reach + at);
}
