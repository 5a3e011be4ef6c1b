// Sums become offsets: each the sum of all before it, in place, modulo 2^32; and the sum of all.
// [Blelloch90, section 1.3: the scan of the blocks' sums]
//
// One group goes through all sums tile by tile. There is one sum for every 4096 items (512 pixels
// of a picture), so that its time does not count beside that of the items.
//
// Work size    one work-group of any size
// Writes       sums, total
// Cost         12 bytes a sum: read twice, written once
// SPDX-License-Identifier: MIT
#include "parallel/scan.clh"

kernel void parallel_offsets(
    const uint    count,
    global uint*  restrict sums,   // [count]
    global uint*  restrict total,  // [1] or null
    local uint*   runs)            // [local size]
{
    local uint leaves[PARALLEL_LEAVES];
    uint before = 0;
    for (uint first = 0; first < count; first += PARALLEL_TILE) {
        sum_leaves(sums, first, count, leaves);
        uint sum = leaves_before(leaves, runs);
        for (uint leaf = (uint)get_local_id(0); leaf < PARALLEL_LEAVES;
             leaf += (uint)get_local_size(0))
            leaf_scan(sums, sums, first + leaf * PARALLEL_LEAF, count, before + leaves[leaf]);
        before += sum;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (total != 0 && get_local_id(0) == 0) total[0] = before;
}
