// Gives vertices new places and normals: those of the device that the caller's buffers contain.
//
//   local = ((position + given_from) - frame_origin) * 2^exponent
//
// in double precision, rounded once after each operation and once to float, which are the bits
// that the host computes from doubles when a scene is loaded.
// [derived: SceneFrame::to_local; scene/wide.clh for the sums]
//
// Work size    1D, one work-item a vertex of the device; any local size; tail guarded
// Writes       its own vertex, unless a number is not finite; counts in status by integer atomics
// SPDX-License-Identifier: MIT
#include "clgi/shared/scene.h"
#include "scene/wide.clh"

CLGI_INLINE int finite_bits(uint bits) { return (bits & 0x7f800000u) != 0x7f800000u; }

// What is there only ever grows: a stale look can cost an atomic but never lose one.
CLGI_INLINE void raise(volatile global uint* most, uint value) {
#ifndef CLGI_ATOMICS_ONLY
    if (*most >= value) return;
#endif
    atomic_max(most, value);
}

// One coordinate. axis: 0, 1 or 2.
CLGI_INLINE uint local_bits(const MoveParams* params, int axis, uint position) {
    ulong from = (ulong)params->given_from[2 * axis + 1] << 32 | params->given_from[2 * axis];
    ulong origin = (ulong)params->frame_origin[2 * axis + 1] << 32 | params->frame_origin[2 * axis];
    ulong world = wide_add(from, wide_from_float(position));
    return wide_to_float(wide_add(world, origin ^ WIDE_SIGN), params->exponent);
}

kernel void scene_move(
    const MoveParams       params,
    global const uint*     restrict vertex_order,     // [vertex_count] index in the file
    global const uint4*    restrict given_positions,  // [count] floats: xyz metres, from given_from
    global const uint4*    restrict given_normals,    // [count] floats: xyz unit; see MOVE_NORMALS
    global uint4*          restrict positions,        // [vertex_count] floats, local frame
    global uint4*          restrict normals,          // [vertex_count] floats
    volatile global uint*  restrict status)           // [MOVE_STATUS_WORDS] only added to
{
    uint vertex = (uint)get_global_id(0);
    if (vertex >= params.vertex_count) return;
    uint place = vertex_order[vertex] - params.first;  // huge where it lies before the first
    if (place >= params.count) return;

    uint4 position = given_positions[place];
    int usable = finite_bits(position.x) && finite_bits(position.y) && finite_bits(position.z);
    uint4 moved = (uint4)(0);
    if (usable) {
        moved = (uint4)(local_bits(&params, 0, position.x), local_bits(&params, 1, position.y),
                        local_bits(&params, 2, position.z), 0);
        usable = finite_bits(moved.x) && finite_bits(moved.y) && finite_bits(moved.z);
    }
    int turned = (params.flags & MOVE_NORMALS) != 0;
    uint4 normal = turned ? given_normals[place] : (uint4)(0);
    usable = usable && finite_bits(normal.x) && finite_bits(normal.y) && finite_bits(normal.z);
    if (!usable) {
        atomic_inc(status + MOVE_NOT_FINITE);
        return;
    }

    positions[vertex] = moved;
    if (turned) normals[vertex] = (uint4)(normal.xyz, 0);
    float3 p = (float3)(as_float(moved.x), as_float(moved.y), as_float(moved.z));
    float3 beyond = max(params.low.xyz - p, p - params.high.xyz);
    raise(status + MOVE_LEFT, max(beyond.x, max(beyond.y, beyond.z)) > 0.0f ? 1u : 0u);
    raise(status + MOVE_FARTHEST, as_uint(dot(p, p)));  // bits of positive floats rise with them
}
