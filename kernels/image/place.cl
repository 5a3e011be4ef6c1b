// Puts the irradiance of the listed pixels where they came from.
// [Cochran07, section 4: recomputed values replace the interpolated ones]
//
// Work size    1D, one work-item for every CLGI_WIDTH listed points (rounded up), at most one for
//              every CLGI_WIDTH pixels; any local size
// Writes       irradiance of its own pixels; every pixel is listed once at most
// SPDX-License-Identifier: MIT
#include "planes.clh"
#include "clgi/shared/image.h"

kernel void image_place(
    const RefineParams   params,
    global const uint*   restrict point_count,  // [1]
    global const uint*   restrict pixels,       // [stride] pixel of each listed point
    global const float*  restrict refined,      // [IRRADIANCE_PLANES][stride] of listed points
    global float*        restrict irradiance)   // [IRRADIANCE_PLANES][stride] of pixels
{
    uint first = (uint)get_global_id(0) * CLGI_WIDTH;
    uint last = min(first + CLGI_WIDTH, point_count[0]);
    for (uint place = first; place < last; ++place)
        for (uint plane = 0; plane < IRRADIANCE_PLANES; ++plane)
            row_copy_one(irradiance_row(refined, plane, params.stride), place,
                         irradiance_row(irradiance, plane, params.stride), pixels[place]);
}
