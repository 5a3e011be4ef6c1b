// The sum of each tile of float4, component by component: first of two steps.
// [Higham93, section 3: pairwise summation]
//
// The tree is the same for every size of the work-group: the same bits. Error bound: sum_merge.cl.
//
// Work size    1D, one work-group of any size a tile
// Writes       sums of all tiles of `most` items; 0 for those behind the last item
// Cost         16 bytes read an item
// SPDX-License-Identifier: MIT
#include "parallel/sum.clh"

kernel void parallel_sum_tiles(
    const uint            most,
    global const uint*    restrict count,  // [1] or null: most
    global const float4*  restrict items,  // [most]
    global float4*        restrict sums)   // [tiles]
{
    local float4 leaves[PARALLEL_LEAVES];
    uint tile = (uint)get_group_id(0);
    float4 sum = tile_total(items, tile * PARALLEL_TILE, item_count(most, count), leaves);
    if (get_local_id(0) == 0) sums[tile] = sum;
}
