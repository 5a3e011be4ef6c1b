// One step of the iteration over the records' light.
//
//   next_i = B_i + R_i + sum_j T_ij light_j     (link.cl)                 [derived: Jacobi iteration]
//
// light: that of the step before, sharpened (sharpen.cl).
// What is shown of it lacks the light of the sky's bright parts, which light pixels as lamps do.
//
// Work size    1D, one work-item a record and channel; any local size; tail guarded
// Writes       its own light, and what is shown of it
// SPDX-License-Identifier: MIT
#include "clgi/shared/cache.h"
#include "packet.clh"

kernel void cache_bounce(
    const CacheBounceParams  params,
    global const float*      restrict rows,      // [record][3][row_stride]
    global const float*      restrict base,      // [3][stride]
    global const float*      restrict reflected,  // [3][stride]
    global const float*      restrict bright,    // [3][stride] of base
    global const float*      restrict light,     // [3][stride] before this step
    global float*            restrict next,      // [3][stride]
    global float*            restrict shown)     // [3][stride]
{
    uint item = (uint)get_global_id(0);
    if (item >= 3 * params.record_count) return;
    uint channel = item / params.record_count, record = params.first + item % params.record_count;
    uint stride = params.stride;
    global const float* row = rows + ((ulong)record * 3 + channel) * params.row_stride;
    global const float* from = light + channel * stride;
    floatp sums = packet_zero;
    for (uint k = 0; k < params.row_stride; k += CLGI_WIDTH)
        sums = fma(packet_load(row + k), packet_load(from + k), sums);
    float lanes[CLGI_WIDTH];
    packet_store(sums, lanes);
    float sum = 0.0f;
    for (int k = 0; k < CLGI_WIDTH; ++k) sum += lanes[k];
    uint at = channel * stride + record;
    float found = base[at] + reflected[at] + sum;
    next[at] = found;
    shown[at] = found - bright[at];
}
