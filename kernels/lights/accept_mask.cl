// Which Halton points on the sphere around a spotlight fall into its cone.
//
// The points stand still in the world whatever the light does; the cone moves over them. So a
// turned or widened spotlight keeps the points that it still covers.  [Cochran07, section 3.1]
//
// Work size    1D, one work-item for every 32 candidates; any local size; tail guarded
// Writes       its own word: bit k is candidate 32 * item + k + 1 (index 0, the pole, is not used)
// SPDX-License-Identifier: MIT
#include "clgi/shared/halton.h"
#include "clgi/shared/lights.h"
#include "frame.clh"

kernel void lights_accept_mask(
    const AcceptParams      params,
    global const Emitter*   restrict emitters,  // [emitter_count]
    global uint*            restrict mask)      // [candidate_count / 32]
{
    uint word = (uint)get_global_id(0);
    if (word >= params.candidate_count / 32) return;
    float4 axis = emitters[params.emitter].axis;
    float4 shift = emitters[params.emitter].shift;
    uint bits = 0;
    for (uint k = 0; k < 32; ++k) {
        uint index = word * 32 + k + 1;
        float3 s = sphere_direction(shifted_radical_inverse(index, 2, shift.x),
                                    shifted_radical_inverse(index, 3, shift.y));
        if (dot(s, axis.xyz) >= axis.w) bits |= 1u << k;
    }
    mask[word] = bits;
}
