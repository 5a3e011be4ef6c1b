// Light of a batch of VPLs at every texel, added to what is there.
//
//   I(u, v) += sum_i F'_i(u, v) E_i,   E_i = rho_i A_i I_i                   [Schaerfig16, Eq. 9]
//
// The factors that balance the transport stay out: only products of a shooter's and a receiver's
// mean something, and a texel has none.
//
// The paper projects the picture of each VPL into the atlas. Here every texel looks up the VPL's
// depth maps: no seams, no extrapolation, and no two writers of a texel.
//
// Unlike paper  visibility by depth test at the texel; form factor as vpl/exchange.clh
// Work size     1D, one work-item for every CLGI_WIDTH texels; any local size; tail guarded
// Writes        its own texels; beside the light, the share of the hemisphere that the VPLs fill,
//               however bright their parts are
// Cost          some 90 flops and one look-up a pair that faces each other; 15 for others
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "vpl/exchange.clh"
#include "vpl/hemicube.clh"

kernel void atlas_gather(
    const FillParams     params,
    global const uint*   restrict chosen,      // [first_shooter + shooter_count] sites
    global const View*   restrict views,       // [5 * shooter_count]
    global const uint*   restrict depth,       // [pixels of the views] one or two words each
    global const Site*   restrict sites,
    global const float*  restrict site_planes, // [SITE_PLANES][site_stride]
    global const float*  restrict light,       // [SITE_LIGHT_PLANES][site_stride]
    global const float*  restrict samples,     // [GBUFFER_PLANES][sample_stride]
    global const float*  restrict weights,     // [sample_stride] of the samples
    global const float*  restrict texels,      // [>= GBUFFER_GEOMETRIC + 3][stride]
    global float*        restrict irradiance,  // [3][stride] lux, exposed
    global float*        restrict filled)      // [stride] sum of form factors
{
    uint at = params.first_texel + (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.texel_count) return;
    uint stride = params.stride;
    global const float* from = texels + at;
    floatp px = packet_load(from), py = packet_load(from + stride), pz = packet_load(from + 2 * stride);
    from += GBUFFER_NORMAL * stride;
    floatp nx = packet_load(from), ny = packet_load(from + stride), nz = packet_load(from + 2 * stride);
    from += (GBUFFER_GEOMETRIC - GBUFFER_NORMAL) * stride;
    floatp gx = packet_load(from), gy = packet_load(from + stride), gz = packet_load(from + 2 * stride);
    floatp zero = packet_zero;
    floatp sum[3] = {zero, zero, zero};
    floatp form_factors = zero;
    for (uint s = 0; s < params.shooter_count; ++s) {
        uint site = chosen[params.first_shooter + s];
        float power[3];
        float factor = sites[site].area * (1.0f / CLGI_PI);
        for (int c = 0; c < 3; ++c)
            power[c] = factor * site_planes[(SITE_ALBEDO + c) * params.site_stride + site] *
                       light[(SITE_RECEIVED + c) * params.site_stride + site];
        Shooter shooter = exchange_shooter(sites, site_planes, params.site_stride, site);
        Hemicube cube = hemicube_of(views + 5 * s, params.words);
        floatp dx = px - packet_splat(cube.eye.x);
        floatp dy = py - packet_splat(cube.eye.y);
        floatp dz = pz - packet_splat(cube.eye.z);
        intp wanted = (packet_dot(dx, dy, dz, gx, gy, gz) < 0.0f) &
                      (packet_dot(dx, dy, dz, packet_splat(cube.c.x), packet_splat(cube.c.y),
                                  packet_splat(cube.c.z)) > 0.0f);
        if (!packet_any(wanted)) continue;
        intp seen = hemicube_sees(&cube, depth, dx, dy, dz, gx, gy, gz, wanted);
        if (!packet_any(seen)) continue;
        floatp even;
        floatp kernel_value = exchange_kernel(&shooter, samples, weights, params.sample_stride, px, py, pz, nx,
                                              ny, nz, px - packet_splat(shooter.position.x),
                                              py - packet_splat(shooter.position.y),
                                              pz - packet_splat(shooter.position.z), &even);
        kernel_value = packet_select(zero, kernel_value, seen);
        form_factors = fma(packet_select(zero, even, seen), packet_splat(factor), form_factors);
        for (int c = 0; c < 3; ++c)
            sum[c] = fma(kernel_value, packet_splat(power[c]), sum[c]);
    }
    for (int c = 0; c < 3; ++c) {
        global float* out = irradiance + c * stride + at;
        packet_store(packet_load(out) + sum[c], out);
    }
    packet_store(packet_load(filled + at) + form_factors, filled + at);
}
