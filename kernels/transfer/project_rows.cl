// An environment's picture, summed down its columns: first of three steps of its projection.
//
//   F_lm(column) = sum over rows of L integral Y_lm(theta, 0) sin theta dtheta,  m >= 0
//               [derived: radiance is constant over a texel, and Y_lm is a product of a function of
//                the polar angle and one of the azimuth, so the integral over a texel is exact]
//
// In the picture's own frame, whose polar axis is the picture's. A lane is one float of a row, a
// colour of a texel, so rows are read as they lie.
//
// Work size    2D: one work-item for every CLGI_WIDTH floats of a row (rounded up), and for every
//              PROJECT_ROWS rows; any local size
// Writes       its own sums, 0 beyond the end of a row; adds to non_finite how many floats are not
//              finite; they are read as 0
// Cost         12 bytes read a texel, 3 multiply-adds for each of SH_MOMENTS sums
// SPDX-License-Identifier: MIT
#include "transfer/sh.clh"

enum { MOMENTS = SH_MOMENTS(CLGI_SH_BANDS) };

kernel void transfer_project_rows(
    const ProjectParams  params,
    global const float*  restrict texels,       // [height][width][3] radiance, before the factor
    global const float*  restrict row_weights,  // [height][MOMENTS] steradians per radian
    global float*        restrict sums,         // [blocks][MOMENTS][stride]
    volatile global uint* restrict non_finite)  // [1]
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH, block = (uint)get_global_id(1);
    if (at >= params.stride) return;
    uint length = 3 * params.width;
    ulong end = (ulong)length * params.height;
    uint last = min((block + 1) * PROJECT_ROWS, params.height);
    intp inside = packet_lanes + (int)at < (intp)((int)length);

    floatp total[MOMENTS];
#pragma unroll
    for (int k = 0; k < MOMENTS; ++k) total[k] = packet_zero;
    intp refused = (intp)(0);
    for (uint first = block * PROJECT_ROWS; first < last && at < length; first += PROJECT_RUN) {
        floatp run[MOMENTS];
#pragma unroll
        for (int k = 0; k < MOMENTS; ++k) run[k] = packet_zero;
        for (uint row = first; row < min(first + PROJECT_RUN, last); ++row) {
            ulong place = (ulong)row * length + at;
            floatp light;
            if (place + CLGI_WIDTH <= end) {
                light = packet_load(texels + place);
            } else {
                float lanes[CLGI_WIDTH];
                for (int k = 0; k < CLGI_WIDTH; ++k)
                    lanes[k] = place + k < end ? texels[place + k] : 0.0f;
                light = packet_load(lanes);
            }
            intp odd = packet_magnitude(light) >= NOT_FINITE;
            light = packet_select(light, packet_zero, odd);
            refused += odd & inside & 1;
            global const float* weights = row_weights + (ulong)row * MOMENTS;
#pragma unroll
            for (int k = 0; k < MOMENTS; ++k) run[k] = fma(light, packet_splat(weights[k]), run[k]);
        }
#pragma unroll
        for (int k = 0; k < MOMENTS; ++k) total[k] += run[k];
    }
    global float* out = sums + (ulong)block * MOMENTS * params.stride + at;
#pragma unroll
    for (int k = 0; k < MOMENTS; ++k)
        packet_store(packet_select(packet_zero, total[k], inside), out + (ulong)k * params.stride);

    if (!packet_any(refused != 0)) return;
    int counts[CLGI_WIDTH], count = 0;
    packet_store(refused, counts);
    for (int k = 0; k < CLGI_WIDTH; ++k) count += counts[k];
    atomic_add(non_finite, (uint)count);
}
