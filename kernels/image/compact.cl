// Puts the flagged pixels in a row, in image order, as points that gather can light.
//
// Nothing of it leaves the device: the next passes read the count where this one wrote it.
//                                                              [Cochran07, section 4]
//
// Work size    1D, one work-item a block of COMPACT_BLOCK pixels; any local size; tail guarded
// Cost         1 byte read a pixel, 48 moved a listed point; an offset a block
// Writes       its own part of the list; the last block the count and zeros up to a whole packet
// SPDX-License-Identifier: MIT
#include "planes.clh"
#include "clgi/shared/image.h"

kernel void image_compact(
    const RefineParams   params,
    global const uchar*  restrict flags,   // [width * height]
    global const uint*   restrict offsets,  // [blocks] image_count, then parallel_offsets
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

    uint place = offsets[block];
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
