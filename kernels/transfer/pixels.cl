// Receivers at pixels of a picture, with the exponents of their lobes.
//
// They stand `lift` above their surface along its geometric normal, so that no rounding puts them
// under it. Where no surface is seen, and behind the end of the list, the frame is zero: nothing lies
// above its horizon, and nothing is drawn.             [derived: below_horizon of transfer/cone.clh]
//
// Work size    1D, one work-item a place of the list; any local size; tail guarded
// Writes       the planes and the exponent of its receiver
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/receivers.h"
#include "clgi/shared/scene.h"
#include "planes.clh"
#include "transfer/tangent_frame.clh"

kernel void transfer_pixels(
    const PixelParams    params,
    global const uint*   restrict pixels,    // [*listed] list of pixels
    global const uint*   restrict listed,    // [1] its length
    global const float*  restrict planes,    // [GBUFFER_PLANES][pixel_stride]
    global const int*    restrict ids,       // [GBUFFER_ID_PLANES][pixel_stride]
    global const MaterialRecord* restrict materials,
    global float*        restrict receivers, // [RECEIVER_PLANES][stride]
    global float*        restrict exponents) // [stride]
{
    uint i = (uint)get_global_id(0);
    if (i >= params.count) return;
    float3 position = (float3)(0.0f), normal = (float3)(0.0f);
    float exponent = 0.0f;
    if (params.first + i < *listed) {
        uint pixel = pixels[params.first + i];
        uint stride = params.pixel_stride;
        normal = gbuffer_load3(planes, GBUFFER_NORMAL, stride, pixel);
        position = gbuffer_load3(planes, GBUFFER_POSITION, stride, pixel) +
                   params.lift * gbuffer_load3(planes, GBUFFER_GEOMETRIC, stride, pixel);
        int material = ids[GBUFFER_MATERIAL * stride + pixel];
        if (material >= 0) exponent = materials[material].reflectance.w;
    }
    exponents[i] = exponent;
    Frame frame;
    frame.tangent = frame.bitangent = frame.normal = (float3)(0.0f);
    if (normal.x != 0.0f || normal.y != 0.0f || normal.z != 0.0f) {
        frame = make_frame(normal);
        if (!is_finite3(normal) || !is_finite3(position))
            frame.tangent = frame.bitangent = frame.normal = (float3)(NOT_A_NUMBER);
    } else {
        position = (float3)(0.0f);
    }
    store_receiver(receivers + i, params.stride, position, frame);
}
