// What arrives at receivers made from a list of pixels, put where the pixels are.
//
// Work size    1D, one work-item a place of the list; any local size; tail guarded
// Writes       its pixel                              [derived: a pixel is in the list once]
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/receivers.h"
#include "planes.clh"

kernel void transfer_place(
    const PixelParams    params,
    global const uint*   restrict pixels,  // [*listed] list of pixels
    global const uint*   restrict listed,  // [1] its length
    global const float*  restrict light,   // [3][stride] what arrives at the receivers
    global float*        restrict shown)   // [3][pixel_stride]
{
    uint i = (uint)get_global_id(0);
    if (i >= params.count || params.first + i >= *listed) return;
    uint pixel = pixels[params.first + i];
    for (int c = 0; c < 3; ++c)
        row_store_one(light[c * params.stride + i], irradiance_row(shown, c, params.pixel_stride),
                      pixel);
}
