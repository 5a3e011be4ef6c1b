// How much of what a site sends arrives at every other: rows of the transport.
//
//   T_ij = 1/m sum_k  cos cos' k(d, r_i) v_ik / pi         (irradiance at j for a power of 1 at i)
//
// over the points k of the receiver (points.cl), each seen or not in the shooter's hemicube. The
// paper takes the form factor of the two VPLs times the share of samples that are seen (Eq. 6); the
// samples' own form factors cost nothing more and are right near by.      [Schaerfig16, Eq. 6]
//
// With CLGI_OPEN nothing lies between surfaces: v_ik is 1 where both face each other, and there are no
// hemicubes.
//
// Work size    2D, one work-item for every max(1, CLGI_WIDTH / per_site) receivers, and for every
//              shooter (CLGI_OPEN: TRANSPORT_SHOOTERS shooters); any local size; tail guarded
// Writes       its own numbers of the rows, as half, times row_scale / SITE_ROW_UNIT of the shooter
// Cost         some 90 flops and one look-up a point and shooter; with CLGI_OPEN 40 flops, and 34 for
//              each sample of a shooter near by
// SPDX-License-Identifier: MIT
#include "vpl/exchange.clh"
#ifndef CLGI_OPEN
#include "vpl/hemicube.clh"
#endif

#ifdef CLGI_OPEN
enum { SHOOTERS = TRANSPORT_SHOOTERS };  // that look at the same points, which stay in the cache
#else
enum { SHOOTERS = 1 };
#endif

// Adds the kernel over the points of the receivers, `together` of them from the first on.
CLGI_INLINE void transport_sum(const TransportParams* params, const Shooter* shooter,
#ifndef CLGI_OPEN
                               const Hemicube* cube, global const uint* depth,
#endif
                               global const float* samples, global const float* points,
                               uint receiver, uint together, float* sum) {
    uint stride = params->point_stride;
    float facing = dot(shooter->normal.xyz, shooter->normal.xyz);
    for (uint first = 0; first < params->per_site && facing > 0.0f; first += CLGI_WIDTH) {
        global const float* at = points + receiver * params->per_site + first;
        floatp px, py, pz, nx, ny, nz, gx, gy, gz;
        packet_load3(at + SITE_POINT_POSITION * stride, stride, &px, &py, &pz);
        packet_load3(at + SITE_POINT_GEOMETRIC * stride, stride, &gx, &gy, &gz);
#ifdef CLGI_OPEN
        intp seen = exchange_faces(shooter, params->lift, px, py, pz, gx, gy, gz);
#else
        floatp dx = px - packet_splat(cube->eye.x);
        floatp dy = py - packet_splat(cube->eye.y);
        floatp dz = pz - packet_splat(cube->eye.z);
        intp wanted = packet_dot(dx, dy, dz, gx, gy, gz) < 0.0f;
        wanted &= packet_dot(dx, dy, dz, packet_splat(cube->c.x), packet_splat(cube->c.y),
                             packet_splat(cube->c.z)) > 0.0f;
        if (!packet_any(wanted)) continue;
        intp seen = hemicube_sees(cube, depth, dx, dy, dz, gx, gy, gz, wanted);
#endif
        if (!packet_any(seen)) continue;
        packet_load3(at + SITE_POINT_NORMAL * stride, stride, &nx, &ny, &nz);
        PointReceiver to = {px, py, pz, nx, ny, nz};
        floatp factor = exchange_kernel(shooter, samples, params->sample_stride, &to, seen);
        float lane[CLGI_WIDTH];
        packet_store(packet_select(packet_zero, factor, seen), lane);
        uint of_one = (uint)CLGI_WIDTH / together;
        for (uint r = 0, k = 0; r < together; ++r) {
            float all = sum[r];
            for (uint last = k + of_one; k < last; ++k) all += lane[k];
            sum[r] = all;
        }
    }
}

kernel void vpl_transport(
    const TransportParams  params,
    global const uint*     restrict chosen,   // [first_shooter + shooter_count] sites
#ifndef CLGI_OPEN
    global const View*     restrict views,    // [5 * shooter_count]
    global const uint*     restrict depth,    // [pixels of the views]
#endif
    global const Site*     restrict sites,    // [site_count]
    global const float*    restrict planes,   // [SITE_PLANES][stride]
    global const float*    restrict samples,  // [GBUFFER_PLANES][sample_stride]
    global const float*    restrict points,   // [SITE_POINT_PLANES][point_stride]
    global half*           restrict rows)     // [site_count or shooter_count][stride]
{
    uint together = max((uint)CLGI_WIDTH / params.per_site, 1u);
    uint receiver = (uint)get_global_id(0) * together;
    if (receiver >= params.site_count) return;
    uint after = min(receiver + together, params.site_count);
    uint first = (uint)get_global_id(1) * SHOOTERS;
    uint last = min(first + SHOOTERS, params.shooter_count);
    for (uint s = first; s < last; ++s) {
        uint site = chosen[params.first_shooter + s];
        Shooter shooter = exchange_shooter(sites, planes, params.stride, site);
        float sum[CLGI_WIDTH] = {0.0f};
#ifdef CLGI_OPEN
        transport_sum(&params, &shooter, samples, points, receiver, together, sum);
#else
        Hemicube cube = hemicube_of(views + 5 * s);
        transport_sum(&params, &shooter, &cube, depth, samples, points, receiver, together, sum);
#endif
        float row_scale = params.row_scale *
                          as_float((127u - (sites[site].flags >> SITE_ROW_SHIFT)) << 23);
        global half* row = rows + (ulong)(params.kept ? site : s) * params.stride;
        for (uint r = receiver; r < after; ++r) {
            uint count = min(sites[r].sample_count, params.most_samples);
            float mean = sum[r - receiver] / ((float)count * CLGI_PI) * row_scale;
            // Never more than a half holds, though SITE_ROW_UNIT leaves room for all that a site can
            // send to one place; what is no number stays so and is counted later.
            if (mean > 65504.0f) mean = 65504.0f;
            if (r == site) mean = 0.0f;
            vstore_half(mean, r, row);
        }
    }
}
