// The sum of each tile of numbers, modulo 2^32: first of the three steps of a prefix sum.
// [Blelloch90, section 1.3: sum blocks, scan the sums, scan the blocks]
//
// Work size    1D, one work-group of any size a tile
// Writes       sums of all tiles of `most` items; 0 for those behind the last item
// Cost         4 bytes read an item
// SPDX-License-Identifier: MIT
#include "parallel/scan.clh"

kernel void parallel_scan_sums(
    const uint          most,
    global const uint*  restrict count,  // [1] or null: most
    global const uint*  restrict items,  // [most]
    global uint*        restrict sums,   // [tiles]
    local uint*         runs)            // [local size]
{
    local uint leaves[PARALLEL_LEAVES];
    uint tile = (uint)get_group_id(0);
    sum_leaves(items, tile * PARALLEL_TILE, item_count(most, count), leaves);
    uint sum = leaves_before(leaves, runs);
    if (get_local_id(0) == 0) sums[tile] = sum;
}
