// Listed words of planes in a row: picked[plane][i] = planes[plane][indices[i]].
// [derived: what a compaction does to each plane]
//
// Work size    1D, one work-item a listed word; any local size
// Writes       the first *count words of each plane
// Cost         4 bytes read an index, 4 read and 4 written a word
// SPDX-License-Identifier: MIT
#include "parallel/tile.clh"

kernel void parallel_pick(
    const PickParams    params,
    global const uint*  restrict count,    // [1] or null: most
    global const uint*  restrict indices,  // [most] below stride
    global const uint*  restrict planes,   // [planes][stride]
    global uint*        restrict picked)   // [planes][out_stride]
{
    uint i = (uint)get_global_id(0);
    if (i >= item_count(params.most, count)) return;
    uint from = indices[i];
    for (uint plane = 0; plane < params.planes; ++plane)
        picked[(size_t)plane * params.out_stride + i] = planes[(size_t)plane * params.stride + from];
}
