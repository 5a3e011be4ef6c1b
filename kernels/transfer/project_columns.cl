// The sums of an environment's columns, summed along its rows: second of three steps.
//
//   H_k,+-m(leaf) = sum over the leaf's columns of G_k(column) integral cos or sin(m phi) dphi,
//                   m even for k a cosine and odd for k a sine      [derived: project_rows.cl]
//
// A leaf is PROJECT_LEAF floats of a row. It is always summed PROJECT_LANES floats at a time, and
// these in a fixed order, so the sum does not depend on the width of packets or the work-group.
//
// Work size    2D: one work-item a leaf, and PROJECT_PARTS for each of SH_WAVES waves of the polar
//              angle; any local size
// Writes       its own leaf and wave; nothing in slots without an order
// Cost         4 bytes read a float and block of rows
// SPDX-License-Identifier: MIT
#include "transfer/sh.clh"

// Orders that a work-item sums; where it sums all, sums are read once.
#ifdef CLGI_GROUPS
#define PROJECT_SLOTS PROJECT_FEW
#else
#define PROJECT_SLOTS CLGI_SH_BANDS
#endif
#define PROJECT_PARTS ((CLGI_SH_BANDS + PROJECT_SLOTS - 1) / PROJECT_SLOTS)

// rgb of 16 texels that lie in three vectors, one lane after the other; pairwise.
CLGI_INLINE float3 texels_total(const float16* lanes) {
    float values[PROJECT_LANES];
    for (int k = 0; k < 3; ++k) vstore16(lanes[k], k, values);
    for (int reach = 8; reach > 0; reach /= 2)
        for (int k = 0; k < 3 * reach; ++k) values[k] += values[k + 3 * reach];
    return (float3)(values[0], values[1], values[2]);
}

// The wave of the azimuth that a slot holds: slot m - 1 is the cosine and slot m the sine of order
// m, which is odd or even as asked; order 0 is slot 0. Below 0: there is none.
CLGI_INLINE int azimuth_wave(int slot, int odd) {
    if (slot == 0 && !odd) return 0;
    int sine = (slot & 1) == odd;
    int m = sine ? slot : slot + 1;
    return m < CLGI_SH_BANDS ? 2 * m - 1 + sine : -1;
}

kernel void transfer_project_columns(
    const ProjectParams   params,
    global const float*   restrict sums,            // [blocks][SH_WAVES][stride]
    global const float*   restrict column_weights,  // [SH_WAVES][stride] radians; a texel's weight
                                                    // once for each colour
    global float4*        restrict leaves)          // [stride / PROJECT_LEAF][SH_WAVES][bands] rgb, 0
{
    uint leaf = (uint)get_global_id(0), wave = (uint)get_global_id(1) / PROJECT_PARTS;
    if (leaf * PROJECT_LEAF >= params.stride) return;
    uint blocks = (params.height + PROJECT_ROWS - 1) / PROJECT_ROWS;
    ulong step = (ulong)SH_WAVES(CLGI_SH_BANDS) * params.stride;
    int odd = wave > 0 && (wave & 1) == 0;  // a sine of the polar angle

    int first_slot = (int)(get_global_id(1) % PROJECT_PARTS) * PROJECT_SLOTS;

    float16 slots[PROJECT_SLOTS][3];
#pragma unroll
    for (int slot = 0; slot < PROJECT_SLOTS; ++slot)
        for (int k = 0; k < 3; ++k) slots[slot][k] = 0.0f;
    uint first = leaf * PROJECT_LEAF;
    for (uint at = first; at < first + PROJECT_LEAF; at += PROJECT_LANES)
        for (int k = 0; k < 3; ++k) {
            uint lanes = at + 16 * k;
            float16 light = 0.0f;
            for (uint run = 0; run < blocks; run += PROJECT_RUN) {
                float16 some = 0.0f;
                for (uint block = run; block < min(run + PROJECT_RUN, blocks); ++block)
                    some += vload16(0, sums + block * step + wave * params.stride + lanes);
                light += some;
            }
#pragma unroll
            for (int slot = 0; slot < PROJECT_SLOTS; ++slot) {
                int azimuth = azimuth_wave(first_slot + slot, odd);
                if (azimuth < 0) continue;
                float16 weights = vload16(0, column_weights + azimuth * params.stride + lanes);
                slots[slot][k] = fma(light, weights, slots[slot][k]);
            }
        }
    global float4* out = leaves + (leaf * SH_WAVES(CLGI_SH_BANDS) + wave) * CLGI_SH_BANDS;
    for (int slot = 0; slot < PROJECT_SLOTS; ++slot)
        if (azimuth_wave(first_slot + slot, odd) >= 0)
            out[first_slot + slot] = (float4)(texels_total(slots[slot]), 0.0f);
}
