// What the two sides of triangles reflect diffusely: the mean over their corners of
//
//   L = rho E / pi,   E: what arrives at the vertex on that side
//                                         [Kautz04, section 3: light between vertices is interpolated]
//
// Triangles with a corner whose other side is no receiver reflect nothing from it.
//
// Work size    1D, one work-item a triangle; any local size; tail guarded
// Writes       both sides of its triangle
// SPDX-License-Identifier: MIT
#include "clgi/shared/receivers.h"
#include "packet.clh"

kernel void transfer_exitance(
    const BounceParams    params,
    global const uint4*   restrict triangles,    // [triangle_count] that block
    global const uint*    restrict other_side,   // of vertices: receiver, or RECEIVER_NONE
    global const float*   restrict reflectance,  // [3][receiver_stride] diffuse
    global const float*   restrict irradiance,   // [3][receiver_stride] exposed
    global float4*        restrict exitance)     // [triangle_count] fronts, then backs: rgb
{
    uint t = (uint)get_global_id(0);
    if (t >= params.triangle_count) return;
    uint4 corners = triangles[t];
    uint front[3] = {corners.x, corners.y, corners.z};
    for (int side = 0; side < 2; ++side) {
        float sum[3] = {0.0f, 0.0f, 0.0f};
        int whole = 1;
        for (int k = 0; k < 3; ++k) {
            uint receiver = side ? other_side[front[k]] : front[k];
            if (receiver == RECEIVER_NONE) {
                whole = 0;
                continue;
            }
            for (int c = 0; c < 3; ++c) {
                uint at = (uint)c * params.receiver_stride + receiver;
                sum[c] = fma(reflectance[at], irradiance[at], sum[c]);
            }
        }
        float share = whole ? 1.0f / (3.0f * CLGI_PI) : 0.0f;
        exitance[side * params.triangle_count + t] =
            (float4)(sum[0] * share, sum[1] * share, sum[2] * share, 0.0f);
    }
}
