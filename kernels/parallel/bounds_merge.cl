// The box around the boxes of all tiles: second of two steps. The count of NaN is modulo 2^32.
// [derived: minimum and maximum in the total order of the floats' bits: any tree gives the same]
//
// Work size    one work-group of any size
// Writes       result
// Cost         48 bytes read a tile
// SPDX-License-Identifier: MIT
#include "parallel/bounds.clh"

kernel void parallel_bounds_merge(
    const uint             tiles,
    global const ItemBounds*   restrict boxes,   // [tiles]
    global ItemBounds*         restrict result,  // [1]
    local BoundsKeys*      candidates)       // [local size]
{
    BoundsKeys mine = bounds_none();
    for (uint tile = (uint)get_local_id(0); tile < tiles; tile += (uint)get_local_size(0)) {
        ItemBounds box = boxes[tile];
        bounds_add(&mine, bounds_keys(as_int4(box.lower)), bounds_keys(as_int4(box.upper)));
        mine.nans += box.nans;
    }
    mine = bounds_of_group(mine, candidates);
    if (get_local_id(0) == 0) result[0] = bounds_result(mine);
}
