// The picture: emission, shadowed direct light, indirect light less its negative.
//
//   L = L_e + rho/pi (E_direct + max(0, I_s - I_n)) + k_s (n + 2)/(2 pi) cos^n alpha E_direct
//                                                              [Cochran07, section 3.4]
//
// The lobe is the normalised modified Phong lobe of docs/materials.md, lit by the sources only.
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       radiance of its own pixels, finite and not negative; non_finite counts the packets
//              that were not
// SPDX-License-Identifier: MIT
#include "lights/disc.clh"
#include "lights/sample.clh"
#include "lights/shadow.clh"
#include "planes.clh"
#include "scene/buffers.clh"
#include "clgi/shared/image.h"

#define LARGEST_FLOAT 3.40282347e38f

static floatp dot3(floatp x, floatp y, floatp z, float4 v) {
    floatp zero = packet_zero;
    return packet_dot(x, y, z, packet_splat(v.x), packet_splat(v.y), packet_splat(v.z));
}

// Not a number and not finite become 0 and the largest float; counted, so never in silence.
static floatp mended(floatp value) {
    uintp magnitude = packet_bits(value) & 0x7fffffffu;
    value = packet_select(value, packet_zero, magnitude > 0x7f800000u);
    return packet_min(value, packet_splat(LARGEST_FLOAT));
}

kernel void image_combine(
    const CombineParams            params,
    const View                     view,
    global const Emitter*          restrict emitters,    // [emitter_count]
    global const View*             restrict views,       // of all emitters
    global const ulong*            restrict visibility,  // [pixels of all views]
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
    floatp albedo[3];
    #pragma unroll
    for (int c = 0; c < 3; ++c)
        albedo[c] = row_load(gbuffer_row(planes, GBUFFER_ALBEDO + c, stride), pixel);

    if ((params.effects & COMBINE_DIRECT) && packet_any(surface)) {
        ShadowPoint point;
        point.x = row_load(gbuffer_row(planes, GBUFFER_POSITION, stride), pixel);
        point.y = row_load(gbuffer_row(planes, GBUFFER_POSITION + 1, stride), pixel);
        point.z = row_load(gbuffer_row(planes, GBUFFER_POSITION + 2, stride), pixel);
        point.gx = row_load(gbuffer_row(planes, GBUFFER_GEOMETRIC, stride), pixel);
        point.gy = row_load(gbuffer_row(planes, GBUFFER_GEOMETRIC + 1, stride), pixel);
        point.gz = row_load(gbuffer_row(planes, GBUFFER_GEOMETRIC + 2, stride), pixel);

        // The lobe's mirror direction and its parameters, where any material has a lobe.
        floatp mx = zero, my = zero, mz = zero;
        floatp coat = zero, share = zero, exponent = zero, per_diffuse = zero;
        if (params.effects & COMBINE_SPECULAR) {
            float lanes[4][CLGI_WIDTH];
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                // Past the last pixel another renderer may have left anything.
                int material = pixel + k < params.width * params.height
                                   ? ids[GBUFFER_MATERIAL * stride + pixel + k] : -1;
                float4 r = material < 0 ? (float4)(0.0f) : materials[material].reflectance;
                lanes[0][k] = r.x > 0.0f ? 1.0f / r.x : 0.0f;
                lanes[1][k] = r.y;
                lanes[2][k] = r.z;
                lanes[3][k] = r.w;
            }
            per_diffuse = packet_load(lanes[0]);
            coat = packet_load(lanes[1]);
            share = packet_load(lanes[2]);
            exponent = packet_load(lanes[3]);
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

        for (uint e = 0; e < params.emitter_count; ++e) {
            global const Emitter* emitter = emitters + e;
            uint kind = emitter->kind & EMITTER_KIND;
            float4 axis = emitter->axis;
            floatp tx = packet_splat(-axis.x), ty = packet_splat(-axis.y), tz = packet_splat(-axis.z);
            floatp strength = one;  // times the intensity: irradiance at normal incidence
            if (kind != EMITTER_DIRECTIONAL) {
                float4 position = emitter->position;
                tx = position.x - point.x;
                ty = position.y - point.y;
                tz = position.z - point.z;
                floatp square = packet_dot(tx, ty, tz, tx, ty, tz);
                floatp distance = sqrt(square);
                floatp per_distance = 1.0f / packet_select(one, distance, distance > 0.0f);
                tx *= per_distance;
                ty *= per_distance;
                tz *= per_distance;
                floatp along = -dot3(tx, ty, tz, axis);  // cosine at the source
                if (kind == EMITTER_AREA) {
                    // disc_kernel wants the cosines times d^2.
                    float radius2 = emitter->area / CLGI_PI;
                    strength = disc_kernel(packet_max(along, zero) * square, square,
                                           packet_splat(radius2), packet_splat(radius2 * radius2)) *
                               (1.0f / CLGI_PI);
                } else {
                    strength = packet_select(zero, per_distance * per_distance, square > 0.0f);
                    if (kind == EMITTER_SPOT) {
                        float cos_outer = axis.w;
                        float cos_inner = emitter->right.w;
                        float per_step = 1.0f / max(cos_inner - cos_outer, 1e-7f);
                        floatp t = packet_min(packet_max((along - cos_outer) * per_step, zero), one);
                        // A hard edge (inner = outer) belongs to the cone.
                        t = packet_select(t, one, along >= cos_inner);
                        strength *= t * t;
                    }
                    if (emitter->range > 0.0f) {
                        floatp q = distance * (1.0f / emitter->range);
                        q = q * q;
                        strength *= packet_max(1.0f - q * q, zero);
                    }
                }
            }
            floatp cosine = packet_dot(nx, ny, nz, tx, ty, tz);
            intp facing = (cosine > 0.0f) &
                          (packet_dot(point.gx, point.gy, point.gz, tx, ty, tz) > 0.0f) &
                          (strength > 0.0f);
            if (!packet_any(facing)) continue;
            floatp lit = shadow_lit(emitter, views, visibility, &point, facing, params.texel_bias);
            floatp arriving = packet_select(zero, strength * cosine * lit, facing);
            direct[0] = fma(arriving, packet_splat(emitter->intensity.x), direct[0]);
            direct[1] = fma(arriving, packet_splat(emitter->intensity.y), direct[1]);
            direct[2] = fma(arriving, packet_splat(emitter->intensity.z), direct[2]);
            if (params.effects & COMBINE_SPECULAR) {
                floatp alpha = packet_max(packet_dot(mx, my, mz, tx, ty, tz), zero);
                floatp lobe = (exponent + 2.0f) * (0.5f / CLGI_PI) *
                              packet_select(zero, pow(alpha, exponent), alpha > 0.0f) * arriving;
                lobe = packet_select(zero, lobe, coat + share > 0.0f);
                glossy[0] = fma(lobe, packet_splat(emitter->intensity.x), glossy[0]);
                glossy[1] = fma(lobe, packet_splat(emitter->intensity.y), glossy[1]);
                glossy[2] = fma(lobe, packet_splat(emitter->intensity.z), glossy[2]);
            }
        }
        for (int c = 0; c < 3; ++c)
            glossy[c] *= fma(share, albedo[c] * per_diffuse, coat);
    }

    // By bits: fast math takes every number for finite.
    intp bad = (intp)(0);
    floatp out[3];
    #pragma unroll
    for (int c = 0; c < 3; ++c) {
        floatp light = direct[c];
        if (params.effects & COMBINE_INDIRECT)
            light += packet_max(row_load(irradiance_row(irradiance, c, stride), pixel), zero);
        out[c] = fma(albedo[c] * (1.0f / CLGI_PI), light, glossy[c]);
        if (params.effects & COMBINE_EMISSION)
            out[c] += row_load(gbuffer_row(planes, GBUFFER_EMISSION + c, stride), pixel);
        out[c] = packet_select(zero, out[c] * params.exposure, surface);
        bad |= (packet_bits(out[c]) & 0x7fffffffu) >= 0x7f800000u;
    }
    if (packet_any(bad)) {
        atomic_inc(non_finite);
        for (int c = 0; c < 3; ++c) out[c] = mended(out[c]);
    }
    #pragma unroll
    for (int c = 0; c < 3; ++c)
        packet_store(packet_max(out[c], zero), radiance + c * stride + pixel);
}
