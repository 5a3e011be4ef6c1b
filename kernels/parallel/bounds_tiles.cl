// The box around the float4 of each tile, and how many of their components are NaN: first of two
// steps.
// [derived: minimum and maximum in the total order of the floats' bits: any tree gives the same]
//
// Work size    1D, one work-group of any size a tile
// Writes       boxes of all tiles of `most` items
// Cost         16 bytes read an item
// SPDX-License-Identifier: MIT
#include "parallel/bounds.clh"

kernel void parallel_bounds_tiles(
    const uint          most,
    global const uint*  restrict count,  // [1] or null: most
    global const int4*  restrict items,  // [most] float4, as bits
    global ItemBounds*      restrict boxes,  // [tiles]
    local BoundsKeys*   candidates)      // [local size]
{
    uint tile = (uint)get_group_id(0);
    uint first = tile * PARALLEL_TILE;
    uint last = min(first + PARALLEL_TILE, item_count(most, count));
    const BoundsKeys none = bounds_none();
    BoundsKeys mine = none;
    int4 nans = (int4)(0);
    for (uint i = first + (uint)get_local_id(0); i < last; i += (uint)get_local_size(0)) {
        int4 bits = items[i];
        int4 nan = (bits & (int4)(0x7fffffff)) > (int4)(0x7f800000);  // -1 or 0
        int4 keys = bounds_keys(bits);
        bounds_add(&mine, select(keys, none.lower, nan), select(keys, none.upper, nan));
        nans -= nan;
    }
    mine.nans = (uint)(nans.x + nans.y + nans.z + nans.w);
    mine = bounds_of_group(mine, candidates);
    if (get_local_id(0) == 0) boxes[tile] = bounds_result(mine);
}
