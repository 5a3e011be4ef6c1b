// What leaves leaves before any light is exchanged, and what they reflect: means over their sample
// points. Direct light is shadowed already, so it makes no antiradiance.
//                                                         [Dachsbacher07, section 3.3]
//
// Work size    1D, one work-item a leaf; any local size; tail guarded
// Writes       the source and the reflectance of its leaf
// SPDX-License-Identifier: MIT
#include "clgi/shared/antiradiance.h"
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/scene.h"

kernel void antiradiance_sources(
    const LeafPointParams        params,
    global const float*          restrict planes,        // [GBUFFER_PLANES][stride] full storage
    global const int*            restrict ids,           // [GBUFFER_ID_PLANES][stride]
    global const float*          restrict irradiance,    // [3][stride] direct, exposed lux
    global const MaterialRecord* restrict materials,
    global float4*               restrict sources,       // [leaf_count] rgb, exposed cd/m^2
    global float4*               restrict reflectances)  // [leaf_count] rgb
{
    uint leaf = (uint)get_global_id(0);
    if (leaf >= params.leaf_count) return;
    float source[3] = {0.0f, 0.0f, 0.0f}, reflectance[3] = {0.0f, 0.0f, 0.0f};
    for (uint k = 0; k < params.samples; ++k) {
        uint point = leaf * params.samples + k;
        int material = ids[GBUFFER_MATERIAL * params.stride + point];
        float diffuse = material < 0 ? 1.0f : materials[material].reflectance.x;
        for (uint c = 0; c < 3; ++c) {
            float share = diffuse * planes[(GBUFFER_BASE + c) * params.stride + point];
            reflectance[c] += share;
            source[c] = fma(share, irradiance[c * params.stride + point], source[c]);
        }
    }
    float one = 1.0f / (float)params.samples, lambert = one * (1.0f / CLGI_PI);
    sources[leaf] = (float4)(source[0], source[1], source[2], 0.0f) * lambert;
    reflectances[leaf] = (float4)(reflectance[0], reflectance[1], reflectance[2], 0.0f) * one;
}
