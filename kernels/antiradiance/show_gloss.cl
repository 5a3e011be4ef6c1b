// Adds to a picture what the lobes of its surfaces make of the light that arrives over links and
// from the sky: at the leaf that is seen, interpolated between its corners bin by bin.
//
//   L = k albedo(v) sum of p_l e_l L_in(l) / sum of p_l e_l,   p_l = max(0, m . -w_l)^n,
//   e_l = omega_l max(0, n . -w_l)
//
// n the pixel's own normal, v the direction to the eye, m it mirrored, k the lobe's colour: as
// between leaves, the lobe is no narrower than a bin and has its own albedo.
//              [Dachsbacher07, Eq. 18, section 4.3; derived: docs/materials.md, antiradiance/lobe.clh]
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       radiance of its own pixel; values that are not finite are counted and left out
// Cost         where there is gloss 55 operations a bin, and 36 bytes that neighbours share
// SPDX-License-Identifier: MIT
#include "antiradiance/lobe.clh"
#include "antiradiance/seen.clh"
#include "clgi/shared/scene.h"
#include "detail_codes.clh"
#include "gloss.clh"

CLGI_INLINE float lane_sum(floatp packet) {
    float lanes[CLGI_WIDTH], sum = 0.0f;
    packet_store(packet, lanes);
    for (int k = 0; k < CLGI_WIDTH; ++k) sum += lanes[k];
    return sum;
}

kernel void antiradiance_show_gloss(
    const ShowGlossParams         params,
    global const uint4*           restrict triangles,   // [triangle_count] of the scene
    global const float4*          restrict positions,   // of its vertices, local frame
    global const MaterialRecord*  restrict materials,
    global const TrianglePatches* restrict roots,       // [triangle_count]
    global const Element*         restrict elements,
    global const PatchCorners*    restrict patches,     // [elements]
    global const uint*            restrict rows,        // [vertices of leaves] in light, or
                                                        // ELEMENT_NONE
    global const float*           restrict bins,        // [4][ROW_BINS] xyz, sr; zero past the last
    global const float*           restrict albedos,     // [materials][ALBEDO_STEPS + 1]
    global const float*           restrict light,       // [rows][3][ROW_BINS] radiance
    global const float*           restrict planes,      // [GBUFFER_PLANES][pixel_stride]
    global const int*             restrict ids,         // [GBUFFER_ID_PLANES][pixel_stride]
    global float*                 restrict radiance,    // [3][pixel_stride] cd/m^2
    global uint*                  restrict non_finite)  // [1]
{
    uint pixel = (uint)get_global_id(0);
    if (pixel >= params.pixel_count) return;
    uint stride = params.pixel_stride;
    int triangle = seen_triangle(ids, stride, pixel, params.triangle_count);
    int material = ids[GBUFFER_MATERIAL * stride + pixel];
    if (triangle < 0 || material < 0) return;
    float4 reflectance = pixel_reflectance(ids, materials, stride, pixel);
    if (!(reflectance.y + reflectance.z > 0.0f)) return;
    SeenLeaf seen =
        seen_leaf(seen_at(params.eye, triangles[triangle], positions, planes, stride, pixel),
                  roots[triangle], elements, params.element_count);
    if (seen.element == ELEMENT_NONE) return;
    global const float* corners[3];
    for (int k = 0; k < 3; ++k) {
        uint row = rows[patches[seen.element].vertex[k]];
        if (row == ELEMENT_NONE) return;  // too little gloss to count
        corners[k] = light + (ulong)row * 3 * ROW_BINS;
    }
    float3 point = gbuffer_load3(planes, GBUFFER_POSITION, stride, pixel);
    float3 normal = gbuffer_load3(planes, GBUFFER_NORMAL, stride, pixel);
    float3 eye = to_eye(params.eye, point);
    eye /= sqrt(dot(eye, eye));
    float3 mirror = mirrored(normal, eye);
    float exponent = lobe_exponent(materials[material].reflectance.w);
    floatp all = packet_zero, sums[3] = {packet_zero, packet_zero, packet_zero};
    floatp a = packet_splat(seen.weights.x), b = packet_splat(seen.weights.y),
           c = packet_splat(seen.weights.z);
    for (uint bin = 0; bin < ROW_BINS; bin += CLGI_WIDTH) {
        // Light comes from where its bin does not lead.
        floatp x = -packet_load(bins + bin), y = -packet_load(bins + ROW_BINS + bin),
               z = -packet_load(bins + 2 * ROW_BINS + bin);
        floatp cosine = packet_dot(x, y, z, packet_splat(normal.x), packet_splat(normal.y),
                                   packet_splat(normal.z));
        if (!packet_any(cosine > packet_zero)) continue;
        floatp share = lobe_toward(x, y, z, mirror.x, mirror.y, mirror.z, exponent) *
                       packet_max(cosine, packet_zero) * packet_load(bins + 3 * ROW_BINS + bin);
        all += share;
        for (int channel = 0; channel < 3; ++channel) {
            uint at = channel * ROW_BINS + bin;
            floatp in = fma(a, packet_load(corners[0] + at),
                            fma(b, packet_load(corners[1] + at), c * packet_load(corners[2] + at)));
            sums[channel] = fma(share, in, sums[channel]);
        }
    }
    float whole = lane_sum(all);
    if (whole == 0.0f) return;
    float scale = lobe_albedo(albedos + material * (ALBEDO_STEPS + 1), dot(normal, eye)) / whole;
    float arrives[3];
    for (int channel = 0; channel < 3; ++channel)
        arrives[channel] = scale * lane_sum(sums[channel]);
    add_gloss(pixel, stride, reflectance, arrives, params.exposure, planes, radiance, non_finite);
}
