// How many flags of each tile are set: first of the three steps of a stable compaction.
// [derived: scan_sums.cl of flags != 0]
//
// Work size    1D, one work-group of any size a tile
// Writes       sums of all tiles of `most` flags; 0 for those behind the last flag
// Cost         1 byte read a flag
// SPDX-License-Identifier: MIT
#include "parallel/flag.clh"

kernel void parallel_flag_sums(
    const uint           most,
    global const uint*   restrict count,  // [1] or null: most
    global const uchar*  restrict flags,  // [most]
    global uint*         restrict sums,   // [tiles]
    local uint*          runs)            // [local size]
{
    local uint leaves[PARALLEL_LEAVES];
    uint tile = (uint)get_group_id(0);
    flag_leaves(flags, tile * PARALLEL_TILE, item_count(most, count), leaves);
    uint sum = leaves_before(leaves, runs);
    if (get_local_id(0) == 0) sums[tile] = sum;
}
