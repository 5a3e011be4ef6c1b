// An environment's picture, summed down its columns: first of three steps of its projection.
//
//   G_k(column) = sum over rows of L integral wave_k(theta) sin theta dtheta
//       [derived: radiance is constant over a texel. Y_lm is a sum of products of a wave of the
//        polar angle (cos k theta for even m, sin k theta for odd m, k <= l) and one of the azimuth,
//        so the integral over a texel is exact, with SH_WAVES sums instead of one for each term]
//
// In the picture's own frame, whose polar axis is the picture's. A lane is one float of a row, a
// colour of a texel, so rows are read as they lie.
//
// Work size    2D: one work-item for every CLGI_WIDTH floats of a row (rounded up), and for
//              every PROJECT_ROWS rows; any local size
// Writes       its own sums, 0 beyond the end of a row; adds to non_finite how many floats are not
//              finite; they are read as 0
// Cost         12 bytes read a texel, 3 SH_WAVES multiply-adds
// SPDX-License-Identifier: MIT
#include "transfer/sh.clh"

enum { WAVES = SH_WAVES(CLGI_SH_BANDS) };

// Floats that follow each other, those that exist.
CLGI_INLINE floatp load_before(global const float* values, ulong at, ulong end) {
    if (at + CLGI_WIDTH <= end) return packet_load(values + at);
    float lanes[CLGI_WIDTH];
    for (int k = 0; k < CLGI_WIDTH; ++k) lanes[k] = at + k < end ? values[at + k] : 0.0f;
    return packet_load(lanes);
}

kernel void transfer_project_rows(
    const ProjectParams     params,
    global const float*     restrict texels,       // [height][width][3] radiance, before the factor
    global const float*     restrict row_weights,  // [height][WAVES]
    global float*           restrict sums,         // [blocks][WAVES][stride]
    volatile global uint*   restrict non_finite)   // [1]
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH, block = (uint)get_global_id(1);
    if (at >= params.stride) return;
    uint length = 3 * params.width;
    ulong end = (ulong)length * params.height;
    uint last = min((block + 1) * PROJECT_ROWS, params.height);
    intp inside = packet_lanes + (int)at < (intp)((int)length);

    floatp total[WAVES];
#pragma unroll
    for (int k = 0; k < WAVES; ++k) total[k] = packet_zero;
    intp refused = (intp)(0);
    for (uint run = block * PROJECT_ROWS; run < last; run += PROJECT_RUN) {
        floatp sum[WAVES];
#pragma unroll
        for (int k = 0; k < WAVES; ++k) sum[k] = packet_zero;
        for (uint row = run; row < min(run + PROJECT_RUN, last); ++row) {
            floatp light = load_before(texels, (ulong)row * length + at, end);
            intp odd = packet_magnitude(light) >= NOT_FINITE;
            light = packet_select(light, packet_zero, odd);
            refused += odd & inside & 1;
            global const float* weights = row_weights + row * WAVES;
#pragma unroll
            for (int k = 0; k < WAVES; ++k) sum[k] = fma(light, packet_splat(weights[k]), sum[k]);
        }
#pragma unroll
        for (int k = 0; k < WAVES; ++k) total[k] += sum[k];
    }
    global float* out = sums + (ulong)block * WAVES * params.stride + at;
#pragma unroll
    for (int k = 0; k < WAVES; ++k)
        packet_store(packet_select(packet_zero, total[k], inside), out + (ulong)k * params.stride);

    if (!packet_any(refused != 0)) return;
    int counts[CLGI_WIDTH], count = 0;
    packet_store(refused, counts);
    for (int k = 0; k < CLGI_WIDTH; ++k) count += counts[k];
    atomic_add(non_finite, (uint)count);
}
