// The picture: emission, shadowed direct light, indirect light less its negative.
//
//   L = L_e + rho/pi (E_direct + max(0, I_s - I_n)) + k_s (n + 2)/(2 pi) cos^n alpha E_direct
//   rho = diffuse share * base colour,  k_s = coat + lobe share * base colour
//                                                              [Cochran07, section 3.4]
//
// The lobe is the normalised modified Phong lobe of docs/materials.md, lit by the emitters only. With
// COMBINE_SPREAD_LOBES the indirect light has rho + m k_s in place of rho, m: lobe_mean.clh.
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       radiance of its own pixels, finite and not negative; non_finite counts the packets
//              that were not
// SPDX-License-Identifier: MIT
#include "detail_codes.clh"
#include "lights/direct.clh"
#include "lobe_mean.clh"
#include "planes.clh"
#include "scene/buffers.clh"
#include "clgi/shared/image.h"

#define LARGEST_FLOAT 3.40282347e38f

// What is no number, or below all of them, becomes 0, and what is above the largest float; counted, so
// never in silence. By bits: to fast math no number is above it.
static floatp sanitised(floatp value) {
    intp bits = as_intp(packet_bits(value));
    value = packet_select(value, packet_zero, (bits & 0x7fffffff) >= NOT_FINITE);
    return packet_select(value, packet_splat(LARGEST_FLOAT), bits == NOT_FINITE);
}

kernel void image_combine(
    const CombineParams            params,
    const View                     view,
    global const Emitter*          restrict emitters,    // [emitter_count]
    global const View*             restrict views,       // of all emitters
    global const uint*             restrict visibility,  // [pixels of all views] one or two words
    global const MaterialRecord*   restrict materials,
    global const float*            restrict planes,      // [GBUFFER_PLANES][stride]
    global const int*              restrict ids,         // [GBUFFER_ID_PLANES][stride]
    global const float*            restrict irradiance,  // [IRRADIANCE_PLANES][stride]
    global float*                  restrict radiance,    // [RADIANCE_PLANES][stride] cd/m^2
    volatile global uint*          restrict non_finite)  // [1]
{
    uint pixel = (uint)get_global_id(0) * CLGI_WIDTH;
    if (pixel >= params.width * params.height) return;
    uint stride = params.stride;
    floatp zero = packet_zero;
    floatp one = packet_splat(1.0f);

    floatp nx = row_load(gbuffer_row(planes, GBUFFER_NORMAL, stride), pixel);
    floatp ny = row_load(gbuffer_row(planes, GBUFFER_NORMAL + 1, stride), pixel);
    floatp nz = row_load(gbuffer_row(planes, GBUFFER_NORMAL + 2, stride), pixel);
    intp surface = packet_dot(nx, ny, nz, nx, ny, nz) > 0.0f;
    floatp direct[3] = {zero, zero, zero};
    floatp glossy[3] = {zero, zero, zero};
    floatp base[3];
    #pragma unroll
    for (int c = 0; c < 3; ++c)
        base[c] = row_load(gbuffer_row(planes, GBUFFER_BASE + c, stride), pixel);
    uintp worst = max(packet_magnitude(nx), max(packet_magnitude(ny), packet_magnitude(nz)));
    if (params.effects & COMBINE_DETAIL)
        detail_normals(packet_load(ids + GBUFFER_DETAIL * stride + pixel), &nx, &ny, &nz);

    // What the material makes of its base colour: a diffuse share, and a lobe. No material: all of
    // it diffuse.
    floatp diffuse = one, coat = zero, share = zero, exponent = zero;
    if (params.effects & COMBINE_MATERIALS) {
        float lanes[4][CLGI_WIDTH];
        for (int k = 0; k < CLGI_WIDTH; ++k) {
            // Past the last pixel another renderer may have left anything.
            float4 r = (float4)(1.0f, 0.0f, 0.0f, 0.0f);
            if (pixel + k < params.width * params.height)
                r = pixel_reflectance(ids, materials, stride, pixel + k);
            lanes[0][k] = r.x;
            lanes[1][k] = r.y;
            lanes[2][k] = r.z;
            lanes[3][k] = r.w;
        }
        diffuse = packet_load(lanes[0]);
        coat = packet_load(lanes[1]);
        share = packet_load(lanes[2]);
        exponent = packet_load(lanes[3]);
    }

    if ((params.effects & COMBINE_DIRECT) && packet_any(surface)) {
        ShadowPoint point = direct_point(planes, stride, pixel);
        worst = max(worst, direct_point_magnitude(&point));

        // The lobe's mirror direction.
        floatp mx = zero, my = zero, mz = zero;
        if (params.effects & COMBINE_SPECULAR) {
            floatp vx = (view.eye.w == 0.0f ? view.eye.x - point.x : zero - view.forward.x);
            floatp vy = (view.eye.w == 0.0f ? view.eye.y - point.y : zero - view.forward.y);
            floatp vz = (view.eye.w == 0.0f ? view.eye.z - point.z : zero - view.forward.z);
            floatp length = sqrt(packet_dot(vx, vy, vz, vx, vy, vz));
            floatp per_length = 1.0f / packet_select(one, length, length > 0.0f);
            floatp twice = 2.0f * packet_dot(nx, ny, nz, vx, vy, vz) * per_length;
            mx = twice * nx - vx * per_length;
            my = twice * ny - vy * per_length;
            mz = twice * nz - vz * per_length;
        }

        ShadowMaps maps = {visibility, (int)params.depth_words};
        for (uint e = 0; e < params.emitter_count; ++e) {
            global const Emitter* emitter = emitters + e;
            DirectRay ray = direct_ray(emitter, &point);
            floatp arriving = direct_arriving(emitter, views, &maps, &point, nx, ny, nz, &ray,
                                              params.texel_bias);
            direct[0] = fma(arriving, packet_splat(emitter->intensity.x), direct[0]);
            direct[1] = fma(arriving, packet_splat(emitter->intensity.y), direct[1]);
            direct[2] = fma(arriving, packet_splat(emitter->intensity.z), direct[2]);
            if (params.effects & COMBINE_SPECULAR) {
                floatp alpha = packet_max(packet_dot(mx, my, mz, ray.x, ray.y, ray.z), zero);
                floatp lobe = (exponent + 2.0f) * (0.5f / CLGI_PI) *
                              packet_select(zero, pow(alpha, exponent), alpha > 0.0f) * arriving;
                lobe = packet_select(zero, lobe, coat + share > 0.0f);
                glossy[0] = fma(lobe, packet_splat(emitter->intensity.x), glossy[0]);
                glossy[1] = fma(lobe, packet_splat(emitter->intensity.y), glossy[1]);
                glossy[2] = fma(lobe, packet_splat(emitter->intensity.z), glossy[2]);
            }
        }
        for (int c = 0; c < 3; ++c)
            glossy[c] *= fma(share, base[c], coat);
    }

    floatp out[3];
    #pragma unroll
    for (int c = 0; c < 3; ++c) {
        floatp light = direct[c];
        if (params.effects & COMBINE_INDIRECT) {
            floatp indirect = row_load(irradiance_row(irradiance, c, stride), pixel);
            worst = max(worst, packet_magnitude(indirect));  // packet_max would hide it
            indirect = packet_max(indirect, zero);
            light += indirect;
            if (params.effects & COMBINE_SPREAD_LOBES)
                glossy[c] = fma(fma(share, base[c], coat) * lobe_mean(exponent) * (1.0f / CLGI_PI),
                                indirect, glossy[c]);
        }
        out[c] = fma(base[c] * diffuse * (1.0f / CLGI_PI), light, glossy[c]);
        if (params.effects & COMBINE_EMISSION)
            out[c] += row_load(gbuffer_row(planes, GBUFFER_EMISSION + c, stride), pixel);
        out[c] = packet_select(zero, out[c] * params.exposure, surface);
        worst = max(worst, packet_magnitude(out[c]));
    }
    intp lanes = (int)pixel + packet_lanes < (int)(params.width * params.height);
    intp bad = lanes & (as_intp(worst) >= NOT_FINITE);
    if (packet_any(bad)) {
        atomic_inc(non_finite);
        for (int c = 0; c < 3; ++c) out[c] = sanitised(out[c]);
    }
    #pragma unroll
    for (int c = 0; c < 3; ++c)
        packet_store(packet_max(out[c], zero), radiance + c * stride + pixel);
}
