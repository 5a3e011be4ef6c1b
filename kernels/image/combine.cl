// The picture: emission, shadowed direct light, indirect light less its negative.
//
//   L = L_e + sum over lights f E_light + rho/pi max(0, I_s - I_n)
//   f: microfacet.clh,  rho = diffuse share * base colour          [Cochran07, section 3.4; glTF 2.0]
//
// Without COMBINE_SPECULAR f is rho/pi.
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       radiance of its own pixels, finite and not negative; non_finite counts the packets
//              that were not
// SPDX-License-Identifier: MIT
#include "detail_codes.clh"
#include "lights/direct.clh"
#include "microfacet.clh"
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
    if (params.effects & COMBINE_MAPPED_NORMALS)
        detail_normals(packet_load(ids + GBUFFER_MAPPED_NORMAL * stride + pixel), &nx, &ny, &nz);

    // What the material makes of its base colour in even light: a diffuse share, and lobes. No
    // material: all of it diffuse.
    floatp diffuse = one;
    float lanes[5][CLGI_WIDTH];
    for (int k = 0; k < CLGI_WIDTH; ++k) {
        // Past the last pixel another renderer may have left anything.
        int there = pixel + k < params.width * params.height;
        float share = 1.0f;
        float4 s = (float4)(0.0f, 1.0f, 0.0f, 0.0f);
        if (there && (params.effects & COMBINE_MATERIALS))
            share = pixel_reflectance(ids, materials, stride, pixel + k).x;
        if (there && (params.effects & COMBINE_SPECULAR))
            s = pixel_surface(ids, materials, stride, pixel + k);
        lanes[0][k] = share;
        lanes[1][k] = s.x;
        lanes[2][k] = s.y * s.y;
        lanes[3][k] = s.z;
        lanes[4][k] = s.w;
    }
    if (params.effects & COMBINE_MATERIALS) diffuse = packet_load(lanes[0]);

    if ((params.effects & COMBINE_DIRECT) && packet_any(surface)) {
        ShadowPoint point = direct_point(planes, stride, pixel);
        worst = max(worst, direct_point_magnitude(&point));

        Microfacet microfacet = {nx,
                                 ny,
                                 nz,
                                 zero - view.forward.x,
                                 zero - view.forward.y,
                                 zero - view.forward.z,
                                 packet_load(lanes[1]),
                                 packet_load(lanes[2]),
                                 packet_load(lanes[3]),
                                 packet_load(lanes[4]),
                                 one};
        if (params.effects & COMBINE_SPECULAR) {
            if (view.eye.w == 0.0f)
                microfacet_toward(view.eye.x - point.x, view.eye.y - point.y, view.eye.z - point.z,
                                  &microfacet);
            microfacet_view(&microfacet);
        }

        ShadowMaps maps = {visibility, (int)params.depth_words};
        for (uint e = 0; e < params.emitter_count; ++e) {
            global const Emitter* emitter = emitters + e;
            DirectRay ray = direct_ray(emitter, &point);
            floatp arriving = direct_arriving(emitter, views, &maps, &point, nx, ny, nz, &ray,
                                              params.texel_bias);
            if (!(params.effects & COMBINE_SPECULAR)) {
                direct[0] = fma(arriving, packet_splat(emitter->intensity.x), direct[0]);
                direct[1] = fma(arriving, packet_splat(emitter->intensity.y), direct[1]);
                direct[2] = fma(arriving, packet_splat(emitter->intensity.z), direct[2]);
                continue;
            }
            if (!packet_any(arriving != 0.0f)) continue;
            Reflected to = microfacet_reflected(&microfacet, ray.x, ray.y, ray.z);
            floatp of_base = to.diffuse + to.tint;
            glossy[0] = fma(fma(base[0], of_base, to.white), arriving * emitter->intensity.x,
                            glossy[0]);
            glossy[1] = fma(fma(base[1], of_base, to.white), arriving * emitter->intensity.y,
                            glossy[1]);
            glossy[2] = fma(fma(base[2], of_base, to.white), arriving * emitter->intensity.z,
                            glossy[2]);
        }
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
        }
        out[c] = fma(base[c] * diffuse * (1.0f / CLGI_PI), light, glossy[c]);
        if (params.effects & COMBINE_EMISSION)
            out[c] += row_load(gbuffer_row(planes, GBUFFER_EMISSION + c, stride), pixel);
        out[c] = packet_select(zero, out[c] * params.exposure, surface);
        worst = max(worst, packet_magnitude(out[c]));
    }
    intp inside = (int)pixel + packet_lanes < (int)(params.width * params.height);
    intp bad = inside & (as_intp(worst) >= NOT_FINITE);
    if (packet_any(bad)) {
        atomic_inc(non_finite);
        for (int c = 0; c < 3; ++c) out[c] = sanitised(out[c]);
    }
    #pragma unroll
    for (int c = 0; c < 3; ++c)
        packet_store(packet_max(out[c], zero), radiance + c * stride + pixel);
}
