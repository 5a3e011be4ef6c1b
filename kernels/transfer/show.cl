// What arrives at vertices, at the pixels of a picture: interpolated over the triangle that is seen,
// from the receivers of the side that is seen.              [Kautz04, section 3; derived: the sides]
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       its own pixel, 0 where no triangle is. What is not finite stays so, for the passes
//              that count it
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/receivers.h"
#include "gbuffer/seen.clh"
#include "planes.clh"

kernel void transfer_show(
    const ShowVerticesParams  params,
    global const uint4*       restrict triangles,  // [triangle_count] of the scene
    global const float4*      restrict positions,  // of its vertices, local frame
    global const uint*        restrict other_side, // of its vertices: receiver, or RECEIVER_NONE
    global const float*       restrict planes,     // [GBUFFER_PLANES][pixel_stride]
    global const int*         restrict ids,        // [GBUFFER_ID_PLANES][pixel_stride]
    global const float*       restrict light,      // [3][receiver_stride] what arrives
    global float*             restrict shown)      // [3][pixel_stride]
{
    uint pixel = (uint)get_global_id(0);
    if (pixel >= params.pixel_count) return;
    uint stride = params.pixel_stride;
    float sum[3] = {0.0f, 0.0f, 0.0f};
    int triangle = seen_triangle(ids, stride, pixel, params.triangle_count);
    if (triangle >= 0) {
        Seen seen = seen_at(params.eye, triangles[triangle], positions, planes, stride, pixel);
        float2 b = seen.weights;
        float weight[3] = {1.0f - b.x - b.y, b.x, b.y};
        uint receiver[3] = {seen.corners.x, seen.corners.y, seen.corners.z};
        if (seen.back)
            for (int k = 0; k < 3; ++k) {
                uint other = other_side[receiver[k]];
                receiver[k] = other == RECEIVER_NONE ? receiver[k] : other;
            }
        for (int c = 0; c < 3; ++c)
            for (int k = 0; k < 3; ++k)
                sum[c] = fma(weight[k], light[c * params.receiver_stride + receiver[k]], sum[c]);
    }
    for (int c = 0; c < 3; ++c) row_store_one(sum[c], irradiance_row(shown, c, stride), pixel);
}
