// Shadowed direct irradiance at any surface points: texels, vertices, centroids.
// [derived: as lights/direct.clh, summed over the emitters]
//
// Work size    1D, one work-item for every CLGI_WIDTH points (rounded up); any local size
// Writes       irradiance of its own points; what is not finite stays so and is counted, a packet
//              at a time
// SPDX-License-Identifier: MIT
#include "lights/direct.clh"
#include "planes.clh"

kernel void lights_direct(
    const DirectParams      params,
    global const Emitter*   restrict emitters,    // [first_emitter + emitter_count]
    global const View*      restrict views,       // of all emitters
    global const uint*      restrict visibility,  // [pixels of all views] one or two words each
    global const float*     restrict planes,      // [> GBUFFER_GEOMETRIC + 2][stride]
    global float*           restrict irradiance,  // [IRRADIANCE_PLANES][stride] lux, exposed
    volatile global uint*   restrict non_finite)  // [1]
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.point_count) return;
    uint stride = params.stride;
    ShadowPoint point = direct_point(planes, stride, at);
    floatp nx = row_load(gbuffer_row(planes, GBUFFER_NORMAL, stride), at);
    floatp ny = row_load(gbuffer_row(planes, GBUFFER_NORMAL + 1, stride), at);
    floatp nz = row_load(gbuffer_row(planes, GBUFFER_NORMAL + 2, stride), at);
    ShadowMaps maps = {visibility, (int)params.depth_words, (int)params.edges};
    uintp worst = max(packet_magnitude(nx), max(packet_magnitude(ny), packet_magnitude(nz)));
    worst = max(worst, direct_point_magnitude(&point));
    floatp sum[3] = {packet_zero, packet_zero, packet_zero};
    for (uint e = 0; e < params.emitter_count; ++e) {
        global const Emitter* emitter = emitters + params.first_emitter + e;
        DirectRay ray = direct_ray(emitter, &point);
        floatp arriving = direct_arriving(emitter, views, &maps, &point, nx, ny, nz, &ray,
                                          params.texel_bias);
        sum[0] = fma(arriving, packet_splat(emitter->intensity.x), sum[0]);
        sum[1] = fma(arriving, packet_splat(emitter->intensity.y), sum[1]);
        sum[2] = fma(arriving, packet_splat(emitter->intensity.z), sum[2]);
    }
    for (int c = 0; c < 3; ++c) worst = max(worst, packet_magnitude(sum[c]));
    intp lanes = (int)at + packet_lanes < (int)params.point_count;
    intp bad = as_intp(worst) >= NOT_FINITE;
    bad = bad & lanes;
    if (packet_any(bad)) {
        atomic_inc(non_finite);
        for (int c = 0; c < 3; ++c)
            sum[c] = packet_select(sum[c], packet_splat(NAN), bad);
    }
    for (int c = 0; c < 3; ++c) {
        Row row = irradiance_row(irradiance, c, stride);
        if (params.add == DIRECT_TAKE) sum[c] = packet_zero - sum[c];
        if (params.add) sum[c] += row_load(row, at);
        row_store(sum[c], row, at);
    }
}
