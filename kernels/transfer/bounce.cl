// Light that the triangles a receiver sees reflect to it: interreflection from the visibility that
// masks are made of. A pixel stands for an equal part of the cosine-weighted hemisphere, so
//
//   E = pi / pixels  sum over pixels of L of the nearest triangle's side
//                                             [Kautz04, section 3.1: the Nusselt analog; derived]
//
// Work size    1D, one work-item a receiver; any local size; tail guarded
// Writes       adds to the irradiance of its receiver, and to non_finite where that makes it so
// SPDX-License-Identifier: MIT
#include "clgi/shared/receivers.h"
#include "finite.clh"
#include "transfer/nearest.clh"

kernel void transfer_bounce(
    const MaskParams         params,
    const BounceParams       bounce,
    global const float*      restrict receivers,  // [RECEIVER_PLANES][receiver_stride]
    BLOCKER_ARGUMENTS,
    global const float*      restrict heights,    // [CLGI_MASK][MASK_COLUMNS] z of pixels
    global const float4*     restrict exitance,   // [triangle_count] fronts, then backs: rgb
    global float*            restrict irradiance, // [3][receiver_stride] exposed lux
    global uint*             restrict non_finite) // [1]
{
    uint receiver = (uint)get_global_id(0);
    if (receiver >= params.receiver_count) return;
    Receiver r = load_receiver(receivers, params.receiver_stride, receiver);
    BlockerLists from = BLOCKER_LISTS;
    float3 sum = (float3)(0.0f);
    for (int packet = 0; packet < COLUMN_PACKETS; ++packet) {
        Nearest nearest;
        find_nearest(r, receiver, packet, params, from, heights, &nearest);
        for (int row = 0; row < CLGI_MASK; ++row) {
            uint triangle[CLGI_WIDTH];
            packet_store(nearest.triangle[row], triangle);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                if (triangle[k] == NO_TRIANGLE) continue;
                uint side = triangle[k] & FROM_BEHIND ? bounce.triangle_count : 0u;
                sum += exitance[side + (triangle[k] & ~FROM_BEHIND)].xyz;
            }
        }
    }
    uint stride = params.receiver_stride;
    global float* at = irradiance + receiver;
    float3 before = (float3)(at[0], at[stride], at[2 * stride]);
    float3 after = before + bounce.per_pixel * sum;
    // What arrived before is counted by the pass that wrote it.
    if (is_finite3(before) && !is_finite3(after)) atomic_inc(non_finite);
    at[0] = after.x;
    at[stride] = after.y;
    at[2 * stride] = after.z;
}
