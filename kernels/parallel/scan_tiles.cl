// The sum of all items before each item, modulo 2^32: last of the three steps of a prefix sum.
// [Blelloch90, section 1.3: the scan of each block, begun with its offset]
//
// Work size    1D, one work-group of any size a tile
// Writes       before, of the first *count items
// Cost         4 bytes read and 4 written an item; with scan_sums 12 bytes an item. A tile is read
//              twice, the second time from cache.
// SPDX-License-Identifier: MIT
#include "parallel/scan.clh"

kernel void parallel_scan_tiles(
    const uint          most,
    global const uint*  restrict count,    // [1] or null: most
    global const uint*  restrict offsets,  // [tiles] from parallel_offsets
    global const uint*  items,             // [most]
    global uint*        before,            // [most] may be items
    local uint*         runs)              // [local size]
{
    local uint leaves[PARALLEL_LEAVES];
    uint tile = (uint)get_group_id(0);
    uint first = tile * PARALLEL_TILE;
    uint end = item_count(most, count);
    sum_leaves(items, first, end, leaves);
    leaves_before(leaves, runs);
    for (uint leaf = (uint)get_local_id(0); leaf < PARALLEL_LEAVES; leaf += (uint)get_local_size(0))
        leaf_scan(items, before, first + leaf * PARALLEL_LEAF, end, offsets[tile] + leaves[leaf]);
}
