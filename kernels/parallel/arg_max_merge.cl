// The largest item of all tiles: second of two steps.
// [derived: the maximum in the order of (value, -index), which is total: any tree gives the same]
//
// Work size    one work-group of any size
// Writes       result
// Cost         16 bytes read a tile
// SPDX-License-Identifier: MIT
#include "parallel/arg_max.clh"

kernel void parallel_arg_max_merge(
    const uint             tiles,
    global const ArgMax*   restrict best,    // [tiles]
    global ArgMax*         restrict result,  // [1]
    local ArgMax*          candidates)       // [local size]
{
    ArgMax mine = arg_max_none();
    for (uint tile = (uint)get_local_id(0); tile < tiles; tile += (uint)get_local_size(0))
        mine = arg_max_better(mine, best[tile]);
    mine = arg_max_of_group(mine, candidates);
    if (get_local_id(0) == 0) result[0] = mine;
}
