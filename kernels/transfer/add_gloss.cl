// Adds to a picture what the lobes of its surfaces make of the light.
//
//   L = (coat + lobe share * base colour) / lobe_mean * light
//   light: of the lobe of transfer/integrate.cl, which reflects lobe_mean of even light in the mean
//                                          [Kautz04, Eq. 1; derived: docs/materials.md, two shares]
//
// Values that are not finite are counted and left out.
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       radiance of its own pixel; adds to non_finite
// SPDX-License-Identifier: MIT
#include "clgi/shared/receivers.h"
#include "clgi/shared/scene.h"
#include "detail_codes.clh"
#include "gloss.clh"
#include "lobe_mean.clh"

kernel void transfer_add_gloss(
    const AddGlossParams           params,
    global const MaterialRecord*   restrict materials,
    global const float*            restrict planes,    // [GBUFFER_PLANES][pixel_stride]
    global const int*              restrict ids,       // [GBUFFER_ID_PLANES][pixel_stride]
    global const float*            restrict light,     // [3][pixel_stride] of the lobes, exposed
    global float*                  restrict radiance,  // [3][pixel_stride] cd/m^2
    global uint*                   restrict non_finite) // [1]
{
    uint pixel = (uint)get_global_id(0);
    if (pixel >= params.pixel_count) return;
    uint stride = params.pixel_stride;
    float4 reflectance = pixel_reflectance(ids, materials, stride, pixel);
    if (!(reflectance.y + reflectance.z > 0.0f)) return;
    reflectance.yz /= lobe_mean(reflectance.w);
    float arrives[3];
    for (int c = 0; c < 3; ++c)
        arrives[c] = row_load_one(irradiance_row(light, c, stride), pixel);
    add_gloss(pixel, stride, reflectance, arrives, params.exposure, planes, radiance, non_finite);
}
