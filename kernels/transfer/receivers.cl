// Receivers and the frames in which their masks are drawn.
//
//   a = -1 / (s + n_z),  s = sign of n_z,
//   tangent   = (1 + s a n_x^2, s a n_x n_y, -s n_x)
//   bitangent = (a n_x n_y, s + a n_y^2, -n_y)                     [Duff17, listing 3]
//
// It has no branch and no pole. A receiver whose position or normal is not finite, or whose normal
// has no length, is counted; its frame is not a number, so its light is none either.
//
// Work size    1D, one work-item a receiver; any local size; tail guarded
// Writes       the planes of its receiver; adds to status
// SPDX-License-Identifier: MIT
#include "clgi/shared/masks.h"
#include "packet.clh"

#define NOT_A_NUMBER as_float(0x7fc00000)

CLGI_INLINE int is_usable(float value) { return (as_uint(value) & 0x7fffffffu) < NOT_FINITE; }

CLGI_INLINE void store3(global float* planes, uint stride, float3 v) {
    planes[0] = v.x;
    planes[stride] = v.y;
    planes[2 * stride] = v.z;
}

kernel void transfer_receivers(
    const ReceiverParams  params,
    global const float4*  restrict positions,  // [receiver_count] local frame
    global const float4*  restrict normals,    // [receiver_count] any length
    global float*         restrict receivers,  // [RECEIVER_PLANES][stride]
    global uint*          restrict status)     // [MASK_STATUS_WORDS]
{
    uint receiver = (uint)get_global_id(0);
    if (receiver >= params.receiver_count) return;
    float3 p = positions[receiver].xyz;
    float3 n = normals[receiver].xyz;
    // By its largest component first: no square is too small or too large.
    float largest = fmax(fmax(fabs(n.x), fabs(n.y)), fabs(n.z));
    int usable = is_usable(p.x) && is_usable(p.y) && is_usable(p.z) && is_usable(n.x) &&
                 is_usable(n.y) && is_usable(n.z) && largest > 0.0f;
    n /= largest;
    n /= sqrt((n.x * n.x + n.y * n.y) + n.z * n.z);
    float s = copysign(1.0f, n.z);
    float a = -1.0f / (s + n.z);
    float b = n.x * n.y * a;
    float3 tangent = (float3)(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
    float3 bitangent = (float3)(b, s + n.y * n.y * a, -n.y);
    if (!usable) {
        atomic_inc(status + MASK_BAD_RECEIVERS);
        tangent = bitangent = n = (float3)(NOT_A_NUMBER);
    }
    global float* planes = receivers + receiver;
    store3(planes + RECEIVER_POSITION * params.stride, params.stride, p);
    store3(planes + RECEIVER_TANGENT * params.stride, params.stride, tangent);
    store3(planes + RECEIVER_BITANGENT * params.stride, params.stride, bitangent);
    store3(planes + RECEIVER_NORMAL * params.stride, params.stride, n);
}
