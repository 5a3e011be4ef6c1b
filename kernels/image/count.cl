// How many pixels of each block are flagged.
// [derived: first of the three steps of a compaction; then parallel/offsets.cl and compact.cl]
//
// Work size    1D, one work-item a block of COMPACT_BLOCK pixels; any local size; tail guarded
// Cost         1 byte read a pixel
// Writes       its own count
// SPDX-License-Identifier: MIT
#include "clgi/shared/image.h"

kernel void image_count(
    const uint           pixels,
    global const uchar*  restrict flags,   // [pixels]
    global uint*         restrict counts)  // [blocks]
{
    uint block = (uint)get_global_id(0);
    uint first = block * COMPACT_BLOCK;
    if (first >= pixels) return;
    uint last = min(first + COMPACT_BLOCK, pixels);
    uint count = 0;
    for (uint pixel = first; pixel < last; ++pixel) count += flags[pixel];
    counts[block] = count;
}
