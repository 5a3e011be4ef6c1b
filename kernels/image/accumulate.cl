// Takes one more sample of a picture into the mean of those before; keeps the luminance of that mean
// as it was, where it is asked for.
//
//   m_k = m_{k-1} + (L_k - m_{k-1}) / k                        [derived: the mean of k values, updated]
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       the means of its own pixels: between the samples, so finite where they are
// Cost         12 flops and 36 bytes a pixel, 4 bytes more to keep what was
// SPDX-License-Identifier: MIT
#include "packet.clh"
#include "clgi/shared/image.h"

kernel void image_accumulate(
    const AccumulateParams  params,
    global const float*     restrict radiance,  // [RADIANCE_PLANES][stride] cd/m^2
    global float*           restrict mean)      // [MEAN_PLANES][stride] cd/m^2
{
    uint pixel = (uint)get_global_id(0) * CLGI_WIDTH;
    if (pixel >= params.pixels) return;
    floatp share = packet_splat(params.share), luminance = packet_zero;
    for (int c = 0; c < RADIANCE_PLANES; ++c) {
        global float* out = mean + c * params.stride + pixel;
        floatp sample = packet_load(radiance + c * params.stride + pixel), before = packet_load(out);
        packet_store(fma(sample - before, share, before), out);
        luminance = fma(before, packet_splat(c == 0 ? 0.2126f : c == 1 ? 0.7152f : 0.0722f), luminance);
    }
    if (params.kept != 0) packet_store(luminance, mean + params.kept * params.stride + pixel);
}
