// What the lobes of leaves make of direct light, into every bin: with all emitters, shadowed, and
// the lobes' colours. Means over the sample points of a leaf.
//
// What arrives from an emitter is mirrored at each sample point. The leaf spreads it about the mean
// of those directions, and normalises it there: what leaves is the lobe's albedo at the points,
// times its colour, times what arrives.     [Dachsbacher07, section 3.3; derived: docs/materials.md]
//
// Work size    1D, one work-item for the leaves whose points fill a packet, one leaf at least; any
//              local size; tail guarded
// Writes       the rows and the colours of its leaves; what is not finite stays so, for the pass
//              that counts it
// Cost         for an emitter 45 operations a bin, and that of lights.direct at the points
// SPDX-License-Identifier: MIT
#include "antiradiance/lobe.clh"
#include "clgi/shared/scene.h"
#include "lights/direct.clh"

// One plane of the points of a packet, anywhere.
#define points_of(plane) \
    ((floatp)(packet_lookup(planes + (ulong)(plane) * params.point_stride, index)))

// What arrives at a leaf from one emitter of intensity 1, and is reflected.
typedef struct {
    float3 toward;     // the mirrored directions, weighted by what arrives
    float3 reflected;  // rgb, times albedo and colour
} LobeLight;

// A packet of bins: their cosines with a normal, and how much of what is mirrored to a direction leaves
// along them.
CLGI_INLINE floatp spread_toward(global const float* bins, float3 normal, float3 toward,
                                 float exponent, floatp* cosine) {
    floatp x = packet_load(bins), y = packet_load(bins + ROW_BINS),
           z = packet_load(bins + 2 * ROW_BINS);
    *cosine = packet_dot(x, y, z, packet_splat(normal.x), packet_splat(normal.y),
                         packet_splat(normal.z));
    return packet_select(packet_zero,
                         lobe_toward(x, y, z, toward.x, toward.y, toward.z, exponent),
                         *cosine > packet_zero);
}

// Adds it to the bins of a row, around the mean direction. One lane wide it finds the shares of the
// bins twice, for lack of room.
CLGI_INLINE void spread(LobeLight light, float3 intensity, float3 normal, float exponent,
                        global const float* bins, global float* row) {
    float3 toward = light.toward / sqrt(dot(light.toward, light.toward));
    floatp sums = packet_zero, cosine;
#if CLGI_WIDTH > 1
    float share[ROW_BINS];
#endif
    for (uint bin = 0; bin < ROW_BINS; bin += CLGI_WIDTH) {
        floatp here = spread_toward(bins + bin, normal, toward, exponent, &cosine);
#if CLGI_WIDTH > 1
        packet_store(here, share + bin);
#endif
        sums = fma(here, cosine * packet_load(bins + 3 * ROW_BINS + bin), sums);
    }
    float lanes[CLGI_WIDTH], sum = 0.0f;
    packet_store(sums, lanes);
    for (int k = 0; k < CLGI_WIDTH; ++k) sum += lanes[k];
    if (sum == 0.0f) return;  // it goes into the surface
    float channel[3] = {light.reflected.x * intensity.x / sum, light.reflected.y * intensity.y / sum,
                        light.reflected.z * intensity.z / sum};
    for (uint bin = 0; bin < ROW_BINS; bin += CLGI_WIDTH) {
#if CLGI_WIDTH > 1
        floatp here = packet_load(share + bin);
#else
        floatp here = spread_toward(bins + bin, normal, toward, exponent, &cosine);
#endif
        for (int c = 0; c < 3; ++c) {
            global float* out = row + c * ROW_BINS + bin;
            packet_store(fma(here, packet_splat(channel[c]), packet_load(out)), out);
        }
    }
}

kernel void antiradiance_gloss_sources(
    const GlossSourceParams      params,
    global const GlossyLeaf*     restrict leaves,      // [leaf_count]
    global const Element*        restrict elements,
    global const float*          restrict bins,        // [4][ROW_BINS] xyz, sr; zero past the last
    global const float*          restrict albedos,     // [materials][ALBEDO_STEPS + 1]
    global const MaterialRecord* restrict materials,
    global const float*          restrict planes,      // [GBUFFER_PLANES][point_stride] full storage
    global const Emitter*        restrict emitters,    // [emitter_count]
    global const View*           restrict views,       // of all emitters
    global const uint*           restrict visibility,  // [pixels of all views] one or two words
    global float4*               restrict colors,      // [leaf_count] rgb
    global float*                restrict sources)     // [leaf_count][3][ROW_BINS] radiance
{
    uint together = max(1u, (uint)CLGI_WIDTH / params.samples);
    uint base = (uint)get_global_id(0) * together;
    if (base >= params.leaf_count) return;
    together = min(together, params.leaf_count - base);
    uint points = together * params.samples;
    float mean = 1.0f / (float)params.samples;

    // The colour at each point is found twice rather than kept: there may be any number.
    for (uint t = 0; t < together; ++t) {
        GlossyLeaf leaf = leaves[base + t];
        float4 shares = materials[leaf.material].reflectance;
        float4 color = (float4)(0.0f);
        for (uint k = 0; k < params.samples; ++k) {
            global const float* from = planes + GBUFFER_BASE * (ulong)params.point_stride +
                                       leaf.row * params.samples + k;
            color += (float4)(fma(shares.z, from[0], shares.y),
                              fma(shares.z, from[params.point_stride], shares.y),
                              fma(shares.z, from[2 * params.point_stride], shares.y), 0.0f);
        }
        colors[base + t] = color * mean;
    }
    global float* rows = sources + (ulong)base * 3 * ROW_BINS;
    for (uint i = 0; i < together * 3 * ROW_BINS; ++i) rows[i] = 0.0f;

    ShadowMaps maps = {visibility, (int)params.depth_words};
    for (uint e = 0; e < params.emitter_count; ++e) {
        global const Emitter* emitter = emitters + e;
        LobeLight light[CLGI_WIDTH];
        for (uint t = 0; t < together; ++t)
            light[t].toward = light[t].reflected = (float3)(0.0f);
        for (uint first = 0; first < points; first += CLGI_WIDTH) {
            uint index[CLGI_WIDTH];
            for (uint k = 0; k < CLGI_WIDTH; ++k) {
                uint point = min(first + k, points - 1);
                index[k] = leaves[base + point / params.samples].row * params.samples +
                           point % params.samples;
            }
            ShadowPoint at = {points_of(GBUFFER_POSITION), points_of(GBUFFER_POSITION + 1),
                              points_of(GBUFFER_POSITION + 2), points_of(GBUFFER_GEOMETRIC),
                              points_of(GBUFFER_GEOMETRIC + 1), points_of(GBUFFER_GEOMETRIC + 2)};
            floatp nx = points_of(GBUFFER_NORMAL), ny = points_of(GBUFFER_NORMAL + 1),
                   nz = points_of(GBUFFER_NORMAL + 2);
            DirectRay ray = direct_ray(emitter, &at);
            floatp arriving = direct_arriving(emitter, views, &maps, &at, nx, ny, nz, &ray,
                                              params.texel_bias);
            floatp cosine = packet_dot(nx, ny, nz, ray.x, ray.y, ray.z), twice = 2.0f * cosine;
            float lanes[5][CLGI_WIDTH];
            packet_store(arriving, lanes[0]);
            packet_store(cosine, lanes[1]);
            packet_store(fma(twice, nx, -ray.x), lanes[2]);
            packet_store(fma(twice, ny, -ray.y), lanes[3]);
            packet_store(fma(twice, nz, -ray.z), lanes[4]);
            for (uint k = 0; k < CLGI_WIDTH && first + k < points; ++k) {
                float arrives = lanes[0][k];
                if (arrives == 0.0f) continue;
                uint t = (first + k) / params.samples;
                uint material = leaves[base + t].material;
                float4 shares = materials[material].reflectance;
                global const float* from =
                    planes + GBUFFER_BASE * (ulong)params.point_stride + index[k];
                float3 color = (float3)(from[0], from[params.point_stride],
                                        from[2 * params.point_stride]);
                float albedo = lobe_albedo(albedos + material * (ALBEDO_STEPS + 1), lanes[1][k]);
                light[t].toward += arrives * (float3)(lanes[2][k], lanes[3][k], lanes[4][k]);
                light[t].reflected += arrives * albedo * mean * fma((float3)(shares.z), color,
                                                                    (float3)(shares.y));
            }
        }
        for (uint t = 0; t < together; ++t) {
            float3 reflected = light[t].reflected;
            if (reflected.x == 0.0f && reflected.y == 0.0f && reflected.z == 0.0f) continue;
            GlossyLeaf leaf = leaves[base + t];
            spread(light[t], emitter->intensity.xyz, elements[leaf.element].normal.xyz,
                   lobe_exponent(leaf.exponent), bins, rows + t * 3 * ROW_BINS);
        }
    }
}
