// The light of an environment and of directional lights in spherical harmonics: last of three steps.
//
//   c_l,+-m = sum over k of T_lmk sum over leaves of H_k,+-m        [derived: project_rows.cl]
//   L_lm    = factor sum over n of R^l_mn c_ln + sum over lights of E Y_lm(s)
//                                                   [Kautz04, section 2.1: L_in]
//
// T writes Y_lm as waves of the polar angle: Y_lm(theta, 0) = sum over k of T_lmk wave_k(theta). R
// turns the picture's frame, whose polar axis is z, into that of the light (clgi/advanced/sh.hpp).
//
// Work size    1D, one work-item a term; any local size; tail guarded
// Writes       its own term; what is not finite stays so
// SPDX-License-Identifier: MIT
#include "transfer/sh.clh"

// Leaves one after the other, in runs.
CLGI_INLINE float3 leaves_total(global const float4* leaves, uint count) {
    float3 total = 0.0f;
    for (uint first = 0; first < count; first += PROJECT_RUN) {
        float3 run = 0.0f;
        for (uint leaf = first; leaf < min(first + PROJECT_RUN, count); ++leaf)
            run += leaves[leaf * (SH_WAVES(CLGI_SH_BANDS) * CLGI_SH_BANDS)].xyz;
        total += run;
    }
    return total;
}

// Term l, n in the picture's frame.
CLGI_INLINE float3 picture_term(global const float4* leaves, uint count,
                                global const float* waves, int l, int n) {
    int m = abs(n), slot = n > 0 ? n - 1 : -n;
    global const float* share = waves + SH_MOMENT(l, m) * CLGI_SH_BANDS;
    float3 sum = 0.0f;
    for (int k = m & 1; k <= l; ++k) {
        int wave = k == 0 ? 0 : 2 * k - 1 + (m & 1);
        sum += share[k] * leaves_total(leaves + wave * CLGI_SH_BANDS + slot, count);
    }
    return sum;
}

kernel void transfer_project_environment(
    const ProjectParams             params,
    global const float4*            restrict leaves,    // of project_columns
    global const float*             restrict waves,     // [SH_MOMENT(bands, 0)][bands] T
    global const float*             restrict rotation,  // block after block, [to][from]
    global const DirectionalLight*  restrict lights,    // [light_count] or null
    global float4*                  restrict light)     // [terms] rgb: exposed cd/m^2 sr; w: 0
{
    int term = (int)get_global_id(0);
    if (term >= SH_TERMS) return;
    int l = 0;
    while ((l + 1) * (l + 1) <= term) ++l;
    int orders = 2 * l + 1;
    global const float* row = rotation + l * (4 * l * l - 1) / 3 + (term - l * l) * orders;
    float3 sum = 0.0f;
    for (int n = 0; n < orders; ++n)
        sum += row[n] * picture_term(leaves, params.stride / PROJECT_LEAF, waves, l, n - l);
    sum *= params.factor.xyz;
    for (uint k = 0; k < params.light_count; ++k) {
        floatp basis[SH_TERMS];  // of packets of one lane, as the pass is built
        float lanes[CLGI_WIDTH];
        float4 s = lights[k].direction;
        sh_evaluate(packet_splat(s.x), packet_splat(s.y), packet_splat(s.z), basis);
        packet_store(basis[term], lanes);
        sum += lights[k].irradiance.xyz * lanes[0];
    }
    light[term] = (float4)(sum, 0.0f);
}
