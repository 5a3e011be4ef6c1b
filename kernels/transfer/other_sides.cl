// The other sides of receivers that lie on surfaces with two: the frame is turned about the diagonal
// of tangent and bitangent, so that it stays right-handed.       [derived: (t, b, n) -> (b, t, -n)]
//
// Work size    1D, one work-item a receiver; any local size; tail guarded
// Writes       the planes of its receiver
// SPDX-License-Identifier: MIT
#include "clgi/shared/receivers.h"
#include "transfer/tangent_frame.clh"

CLGI_INLINE float3 load3(global const float* planes, uint stride) {
    return (float3)(planes[0], planes[stride], planes[2 * stride]);
}

kernel void transfer_other_sides(
    const SidesParams    params,
    global const uint*   restrict fronts,    // [count] receivers that they are the other sides of
    global float*        restrict receivers) // [RECEIVER_PLANES][stride]
{
    uint i = (uint)get_global_id(0);
    if (i >= params.count) return;
    global const float* front = receivers + fronts[i];
    uint stride = params.stride;
    Frame frame;
    frame.tangent = load3(front + RECEIVER_BITANGENT * stride, stride);
    frame.bitangent = load3(front + RECEIVER_TANGENT * stride, stride);
    frame.normal = -load3(front + RECEIVER_NORMAL * stride, stride);
    store_receiver(receivers + params.first + i, stride,
                   load3(front + RECEIVER_POSITION * stride, stride), frame);
}
