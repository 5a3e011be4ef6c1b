// Puts the flagged pixels in a row, in image order, as points that gather can light.
//
// Nothing of it leaves the device: the next passes read the count where this one wrote it.
//                                                              [Cochran07, section 4]
//
// Work size    1D, one work-item a block of COMPACT_BLOCK pixels; any local size; tail guarded
// Writes       its own part of the list; the last block the count and zeros up to a whole packet
// SPDX-License-Identifier: MIT
#include "planes.clh"
#include "clgi/shared/image.h"

kernel void image_compact(
    const RefineParams   params,
    global const uchar*  restrict flags,   // [width * height]
    global const uint*   restrict counts,  // [blocks] from image_count
    global const float*  restrict planes,  // [>= POINT_PLANES][stride]
    global uint*         restrict pixels,       // [stride] pixel of each listed point
    global float*        restrict points,       // [POINT_PLANES][stride]
    global uint*         restrict point_count)  // [1]
{
    uint total = params.width * params.height;
    uint block = (uint)get_global_id(0);
    uint first = block * COMPACT_BLOCK;
    if (first >= total) return;
    uint last = min(first + COMPACT_BLOCK, total);

    uint place = 0;
    for (uint b = 0; b < block; ++b) place += counts[b];
    for (uint pixel = first; pixel < last; ++pixel) {
        if (!flags[pixel]) continue;
        pixels[place] = pixel;
        for (uint plane = 0; plane < POINT_PLANES; ++plane)
            row_copy_one(gbuffer_row(planes, plane, params.stride), pixel,
                         gbuffer_row(points, plane, params.stride), place);
        ++place;
    }
    if (last == total) {
        point_count[0] = place;
        for (; place % CLGI_WIDTH != 0; ++place)
            for (uint plane = 0; plane < POINT_PLANES; ++plane)
                row_clear_one(gbuffer_row(points, plane, params.stride), place);
    }
}
