// The sum of all tiles of float4: second of two steps.
// [Higham93, section 3: the error of a sum is at most its depth times u times the sum of |x|]
//
// A tile of tiles, 2^24 items, is summed pairwise, and these sums one after the other: with
// u = 2^-24 the error is at most (24 + ceil(n / 2^24)) u sum |x|, to first order in u. What is not
// finite stays so.
//
// Work size    one work-group of any size
// Writes       result
// Cost         16 bytes read a tile
// SPDX-License-Identifier: MIT
#include "parallel/sum.clh"

kernel void parallel_sum_merge(
    const uint            tiles,
    global const float4*  restrict sums,    // [tiles]
    global float4*        restrict result)  // [1]
{
    local float4 leaves[PARALLEL_LEAVES];
    float4 total = (float4)(0.0f);
    for (uint first = 0; first < tiles; first += PARALLEL_TILE)
        total += tile_total(sums, first, tiles, leaves);
    if (get_local_id(0) == 0) result[0] = total;
}
