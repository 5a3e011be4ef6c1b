// Sample points of leaves that face backwards: normals are turned round, to the side that the leaf
// is on.                                          [Dachsbacher07, figure 7; derived: both sides]
//
// Work size    1D, one work-item a point of those leaves; any local size; tail guarded
// Writes       the normals of its point
// SPDX-License-Identifier: MIT
#include "clgi/shared/antiradiance.h"
#include "clgi/shared/gbuffer.h"

kernel void antiradiance_turn(
    const LeafPointParams params,
    global float*         restrict planes)  // [>= GBUFFER_BASE][stride] full storage
{
    uint point = params.first_back * params.samples + (uint)get_global_id(0);
    if (point >= params.leaf_count * params.samples) return;
    for (uint plane = GBUFFER_NORMAL; plane < GBUFFER_BASE; ++plane)
        planes[plane * params.stride + point] = -planes[plane * params.stride + point];
}
