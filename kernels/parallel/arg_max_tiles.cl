// The largest item of each tile, and how many are NaN: first of two steps.
// [derived: the maximum in the order of (value, -index), which is total: any tree gives the same]
//
// Work size    1D, one work-group of any size a tile
// Writes       best, of all tiles of `most` items
// Cost         4 bytes read an item
// SPDX-License-Identifier: MIT
#include "parallel/arg_max.clh"

kernel void parallel_arg_max_tiles(
    const uint           most,
    global const uint*   restrict count,  // [1] or null: most
    global const float*  restrict items,  // [most]
    global ArgMax*       restrict best,   // [tiles]
    local ArgMax*        candidates)      // [local size]
{
    uint tile = (uint)get_group_id(0);
    uint end = item_count(most, count);
    ArgMax mine = arg_max_none();
    int key = arg_max_key(mine.value);
    for (uint leaf = (uint)get_local_id(0); leaf < PARALLEL_LEAVES;
         leaf += (uint)get_local_size(0)) {
        uint at = tile * PARALLEL_TILE + leaf * PARALLEL_LEAF;
        uint last = min(at + PARALLEL_LEAF, end);
        if (at + PARALLEL_LEAF <= end) {
            int16 keys = arg_max_keys(as_int16(vload16(0, items + at)));
            int16 nan = keys == (int16)(ARG_MAX_NAN);
            int8 nan8 = nan.lo + nan.hi, key8 = max(keys.lo, keys.hi);
            int4 nan4 = nan8.lo + nan8.hi, key4 = max(key8.lo, key8.hi);
            mine.nans -= (uint)(nan4.x + nan4.y + nan4.z + nan4.w);
            int leaf_key = max(max(key4.x, key4.y), max(key4.z, key4.w));
            // Leaves come in order: one that only reaches the best so far changes nothing.
            if (leaf_key < key || (leaf_key == key && mine.index != ARG_MAX_NONE)) continue;
        } else {
            for (uint i = at; i < last; ++i) mine.nans += arg_max_key(items[i]) == ARG_MAX_NAN;
        }
        for (uint i = at; i < last; ++i) {
            int found = arg_max_key(items[i]);
            if (found == ARG_MAX_NAN) continue;
            if (found < key || (found == key && mine.index != ARG_MAX_NONE)) continue;
            key = found;
            mine.value = items[i];
            mine.index = i;
        }
    }
    mine = arg_max_of_group(mine, candidates);
    if (get_local_id(0) == 0) best[tile] = mine;
}
