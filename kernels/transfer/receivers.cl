// Receivers and the frames in which their masks are drawn (transfer/tangent_frame.clh).
//
// A receiver whose position or normal is not finite, or whose normal has no length, is counted; its
// frame is not a number, so its light is none either.            [derived: nothing is lost silently]
//
// Work size    1D, one work-item a receiver; any local size; tail guarded
// Writes       the planes of its receiver; adds to status
// SPDX-License-Identifier: MIT
#include "transfer/tangent_frame.clh"

kernel void transfer_receivers(
    const ReceiverParams  params,
    global const float4*  restrict positions,  // [receiver_count] local frame
    global const float4*  restrict normals,    // [receiver_count] any length
    global float*         restrict receivers,  // [RECEIVER_PLANES][stride]
    global uint*          restrict status)     // [MASK_STATUS_WORDS]
{
    uint receiver = (uint)get_global_id(0);
    if (receiver >= params.receiver_count) return;
    float3 position = positions[receiver].xyz;
    float3 normal = normals[receiver].xyz;
    int has_length = normal.x != 0.0f || normal.y != 0.0f || normal.z != 0.0f;
    Frame frame = make_frame(normal);
    if (!has_length || !is_finite3(normal) || !is_finite3(position)) {
        atomic_inc(status + MASK_BAD_RECEIVERS);
        frame.tangent = frame.bitangent = frame.normal = (float3)(NOT_A_NUMBER);
    }
    store_receiver(receivers + receiver, params.stride, position, frame);
}
