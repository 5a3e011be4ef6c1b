// Radiance to an 8-bit preview: exposure, then the sRGB curve of IEC 61966-2-1.
// [derived: the standard's encoding, rounded to nearest]
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       its own pixel
// SPDX-License-Identifier: MIT
#include "clgi/shared/image.h"

static uint encode(float linear) {
    float v = clamp(linear, 0.0f, 1.0f);
    float s = v <= 0.0031308f ? 12.92f * v : fma(1.055f, powr(v, 1.0f / 2.4f), -0.055f);
    return (uint)fma(s, 255.0f, 0.5f);
}

kernel void image_tonemap(
    const TonemapParams  params,
    global const float*  restrict radiance,  // [RADIANCE_PLANES][stride]
    global uint*         restrict preview)   // [width * height] RGBA8, alpha 255
{
    uint pixel = (uint)get_global_id(0);
    if (pixel >= params.width * params.height) return;
    float e = params.exposure;
    uint r = encode(radiance[pixel] * e);
    uint g = encode(radiance[params.stride + pixel] * e);
    uint b = encode(radiance[2 * params.stride + pixel] * e);
    preview[pixel] = r | g << 8 | b << 16 | 0xff000000u;
}
