// The indices of the flags that are set, in order: last of the three steps of a stable compaction.
// [derived: an index goes to the place that the prefix sum of flags != 0 names]
//
// Work size    1D, one work-group of any size a tile
// Writes       as many indices as flags are set
// Cost         1 byte read a flag and 4 written an index; with flag_sums 2 bytes a flag. A tile is
//              read twice, the second time from cache.
// SPDX-License-Identifier: MIT
#include "parallel/flag.clh"

kernel void parallel_flag_list(
    const uint           most,
    global const uint*   restrict count,    // [1] or null: most
    global const uint*   restrict offsets,  // [tiles] from parallel_offsets
    global const uchar*  restrict flags,    // [most]
    global uint*         restrict indices,  // [most]
    local uint*          runs)              // [local size]
{
    local uint leaves[PARALLEL_LEAVES];
    uint tile = (uint)get_group_id(0);
    uint first = tile * PARALLEL_TILE;
    uint end = item_count(most, count);
    flag_leaves(flags, first, end, leaves);
    leaves_before(leaves, runs);
    for (uint leaf = (uint)get_local_id(0); leaf < PARALLEL_LEAVES;
         leaf += (uint)get_local_size(0)) {
        uint at = first + leaf * PARALLEL_LEAF;
        uint last = min(at + PARALLEL_LEAF, end);
        uint place = offsets[tile] + leaves[leaf];
        for (uint i = at; i < last; ++i)
            if (flags[i]) indices[place++] = i;
    }
}
