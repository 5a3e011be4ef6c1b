// How much of what a site sends arrives at every other: rows of the transport.
//
//   T_ij = 1/m sum_k  cos cos' k(d, r_i) v_ik / pi         (irradiance at j for a power of 1 at i)
//
// over the first m sample points k of the receiver, each seen or not in the shooter's hemicube. The
// paper takes the form factor of the two VPLs times the share of samples that are seen (Eq. 6); the
// samples' own form factors cost nothing more and are right near by.      [Schaerfig16, Eq. 6]
//
// Work size    2D, one work-item a receiver, and the shooters; any local size; tail guarded
// Writes       its own number of the row, as half, times row_scale
// Cost         some 90 flops and one look-up a sample and shooter
// SPDX-License-Identifier: MIT
#include "vpl/exchange.clh"
#include "vpl/hemicube.clh"

kernel void vpl_transport(
    const TransportParams  params,
    global const uint*     restrict chosen,   // [first_shooter + shooter_count] sites
    global const View*     restrict views,    // [5 * shooter_count]
    global const uint*     restrict depth,    // [pixels of the views]
    global const Site*     restrict sites,    // [site_count]
    global const float*    restrict planes,   // [SITE_PLANES][stride]
    global const float*    restrict samples,  // [GBUFFER_PLANES][sample_stride]
    global half*           restrict rows)     // [site_count or shooter_count][stride]
{
    uint receiver = (uint)get_global_id(0);
    if (receiver >= params.site_count) return;
    uint s = (uint)get_global_id(1);
    uint site = chosen[params.first_shooter + s];
    uint stride = params.sample_stride;
    Shooter shooter = exchange_shooter(sites, planes, params.stride, site);
    Hemicube cube = hemicube_of(views + 5 * s);
    Site own = sites[receiver];
    uint count = min(own.sample_count, params.most_samples);
    floatp zero = packet_zero;
    float sum = 0.0f;
    float facing = dot(shooter.normal.xyz, shooter.normal.xyz);
    for (uint first = 0; first < count && facing > 0.0f; first += CLGI_WIDTH) {
        global const float* at = samples + own.first_sample + first;
        floatp px, py, pz;
        packet_load3(at, stride, &px, &py, &pz);
        at += GBUFFER_NORMAL * stride;
        floatp nx, ny, nz;
        packet_load3(at, stride, &nx, &ny, &nz);
        at += (GBUFFER_GEOMETRIC - GBUFFER_NORMAL) * stride;
        floatp gx, gy, gz;
        packet_load3(at, stride, &gx, &gy, &gz);
        floatp dx = px - packet_splat(cube.eye.x);
        floatp dy = py - packet_splat(cube.eye.y);
        floatp dz = pz - packet_splat(cube.eye.z);
        intp wanted = packet_lanes < (int)(count - first);
        wanted &= packet_dot(dx, dy, dz, gx, gy, gz) < 0.0f;
        wanted &= packet_dot(dx, dy, dz, packet_splat(cube.c.x), packet_splat(cube.c.y),
                             packet_splat(cube.c.z)) > 0.0f;
        if (!packet_any(wanted)) continue;
        intp seen = hemicube_sees(&cube, depth, dx, dy, dz, gx, gy, gz, wanted);
        if (!packet_any(seen)) continue;
        Receiver to = {px, py, pz, nx, ny, nz};
        floatp factor = exchange_kernel(&shooter, samples, stride, &to);
        float lane[CLGI_WIDTH];
        packet_store(packet_select(zero, factor, seen), lane);
        for (int k = 0; k < CLGI_WIDTH; ++k) sum += lane[k];
    }
    float mean = sum / ((float)count * CLGI_PI) * params.row_scale;
    // Never more than a half holds; what is no number stays so and is counted later.
    if (mean > 65504.0f) mean = 65504.0f;
    if (receiver == site) mean = 0.0f;
    vstore_half(mean, receiver, rows + (ulong)(params.kept ? site : s) * params.stride);
}
