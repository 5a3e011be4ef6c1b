// Light of VPLs at every texel that they see, added to what is there.
//
//   I(u, v) += sum_i F'_i(u, v) E_i,   E_i = rho_i A_i I_i                   [Schaerfig16, Eq. 9]
//
// The factors that balance the transport stay out: only products of a shooter's and a receiver's
// mean something, and a texel has none.
//
// Unlike paper  visibility is known before (see.cl); form factor as vpl/exchange.clh
// Terms are added one after the other to what is there, so batches of any size give the same bits.
//
// With CLGI_OPEN nothing lies between surfaces: VPLs and texels that face each other see each other,
// and no bit is read.
//
// Work size     1D, one work-item for every CLGI_WIDTH texels; any local size; tail guarded
// Writes        its own texels; beside the light, the share of the hemisphere that the VPLs fill
// Cost          some 40 flops a pair that sees each other, 2 a pair that does not; 1 bit read.
//               With CLGI_OPEN 45 and 10 flops; for each sample of a VPL near by 34 more
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "vpl/exchange.clh"

kernel void atlas_gather(
    const FillParams     params,
    global const uint*   restrict list,         // sites
    global const uint*   restrict listed,       // [1] how many
    global const Site*   restrict sites,
    global const float*  restrict site_planes,  // [SITE_PLANES][site_stride]
    global const float*  restrict site_power,   // [3][site_stride] exposed lumen
    global const float*  restrict samples,      // [GBUFFER_PLANES][sample_stride]
    global const float*  restrict sample_power, // [3][sample_stride] exposed lumen
    global const float*  restrict texels,       // [>= GBUFFER_NORMAL + 3][stride]; CLGI_OPEN:
                                                // [>= GBUFFER_GEOMETRIC + 3][stride]
#ifndef CLGI_OPEN
    global const uchar*  restrict seen,         // [rows][stride]
#endif
    global float*        restrict gathered,     // [3][stride] lux, exposed
    global float*        restrict filled)       // [stride] sum of form factors
{
    uint at = params.first_texel + (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.texel_count) return;
    uint stride = params.stride;
    global const float* from = texels + at;
    PointReceiver to;
    packet_load3(from, stride, &to.x, &to.y, &to.z);
    from += GBUFFER_NORMAL * stride;
    packet_load3(from, stride, &to.nx, &to.ny, &to.nz);
#ifdef CLGI_OPEN
    floatp gx, gy, gz;
    packet_load3(texels + at + GBUFFER_GEOMETRIC * stride, stride, &gx, &gy, &gz);
#endif
    floatp zero = packet_zero;
    Exchanged sum = {packet_load(gathered + at), packet_load(gathered + stride + at),
                     packet_load(gathered + 2 * stride + at), packet_load(filled + at)};
    uint last = min(params.first_shooter + params.shooter_count, listed[0]);
    for (uint s = params.first_shooter; s < last; ++s) {
        uint site = list[s];
#ifdef CLGI_OPEN
        Shooter shooter = exchange_shooter(sites, site_planes, params.site_stride, site);
        intp sees = exchange_faces(&shooter, params.lift, to.x, to.y, to.z, gx, gy, gz);
        if (!packet_any(sees)) continue;
#else
        uint place = params.flags & FILL_KEPT ? site : s - params.first_shooter;
        global const uchar* row = seen + (ulong)(place / SEEN_VPLS) * stride + at;
        intp sees = (packet_int(packet_load(row)) & (1 << place % SEEN_VPLS)) != 0;
        if (!packet_any(sees)) continue;
        Shooter shooter = exchange_shooter(sites, site_planes, params.site_stride, site);
#endif
        exchange_light(&shooter, site_power + site, params.site_stride, samples, sample_power,
                       params.sample_stride, &to,
                       packet_select(zero, packet_splat(1.0f), sees), &sum);
    }
    packet_store(sum.r, gathered + at);
    packet_store(sum.g, gathered + stride + at);
    packet_store(sum.b, gathered + 2 * stride + at);
    if (params.flags & FILL_FORM_FACTORS) packet_store(sum.form_factor, filled + at);
}
