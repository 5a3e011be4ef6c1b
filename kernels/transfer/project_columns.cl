// The sums of an environment's columns, summed along its rows: second of three steps.
//
//   c_l,+-m(leaf) = sum over the leaf's columns of F_lm(column) integral cos or sin(m phi) dphi
//                                                           [derived: project_rows.cl]
//
// A leaf is PROJECT_LEAF floats of a row. It is always summed PROJECT_LANES floats at a time, and
// these in a fixed order, so the sum does not depend on the width of packets or the work-group.
//
// Work size    2D: one work-item a leaf, and one for each of SH_MOMENTS functions of the polar
//              angle; any local size
// Writes       terms l, m and l, -m of its own leaf
// Cost         4 bytes read a float and block of rows
// SPDX-License-Identifier: MIT
#include "transfer/sh.clh"

// rgb of 16 texels that lie in three vectors, one lane after the other; pairwise.
CLGI_INLINE float3 texels_total(const float16* lanes) {
    float values[PROJECT_LANES];
    for (int k = 0; k < 3; ++k) vstore16(lanes[k], k, values);
    for (int reach = 8; reach > 0; reach /= 2)
        for (int k = 0; k < 3 * reach; ++k) values[k] += values[k + 3 * reach];
    return (float3)(values[0], values[1], values[2]);
}

kernel void transfer_project_columns(
    const ProjectParams   params,
    global const float*   restrict sums,            // [blocks][SH_MOMENTS][stride]
    global const float*   restrict column_weights,  // [2 * bands - 1][stride] radians; cos 0, cos 1,
                                                    // sin 1, cos 2 ..., once for each colour
    global float4*        restrict leaves)          // [stride / PROJECT_LEAF][terms] rgb, 0
{
    uint leaf = (uint)get_global_id(0), moment = (uint)get_global_id(1);
    if (leaf * PROJECT_LEAF >= params.stride) return;
    int l = 0;
    while (SH_MOMENTS(l + 1) <= (int)moment) ++l;
    int m = (int)moment - SH_MOMENTS(l);
    uint blocks = (params.height + PROJECT_ROWS - 1) / PROJECT_ROWS;
    uint step = SH_MOMENTS(CLGI_SH_BANDS) * params.stride;
    global const float* cosines = column_weights + (m > 0 ? 2 * m - 1 : 0) * params.stride;
    global const float* sines = cosines + (m > 0 ? params.stride : 0);

    float16 even[3], odd[3];
    for (int k = 0; k < 3; ++k) even[k] = odd[k] = 0.0f;
    uint first = leaf * PROJECT_LEAF;
    for (uint at = first; at < first + PROJECT_LEAF; at += PROJECT_LANES)
        for (int k = 0; k < 3; ++k) {
            global const float* column = sums + moment * params.stride + at + 16 * k;
            float16 light = 0.0f;
            for (uint run = 0; run < blocks; run += PROJECT_RUN) {
                float16 some = 0.0f;
                for (uint block = run; block < min(run + PROJECT_RUN, blocks); ++block)
                    some += vload16(0, column + (ulong)block * step);
                light += some;
            }
            even[k] = fma(light, vload16(0, cosines + at + 16 * k), even[k]);
            odd[k] = fma(light, vload16(0, sines + at + 16 * k), odd[k]);
        }
    global float4* out = leaves + (ulong)leaf * SH_TERMS + l * l + l;
    out[m] = (float4)(texels_total(even), 0.0f);
    if (m > 0) out[-m] = (float4)(texels_total(odd), 0.0f);
}
