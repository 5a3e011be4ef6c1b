// How often each digit occurs in each tile of keys: first of the three steps of a sorting pass.
// [Satish09, section 4.1: radix sort by counting, prefix sum and scattering]
//
// Work size    1D, one work-group of any size a tile
// Writes       counts, all of it
// Cost         4 bytes read a key, and 4 written a digit and tile
// SPDX-License-Identifier: MIT
#include "parallel/digit.clh"

kernel void parallel_digit_counts(
    const DigitParams   params,
    global const uint*  restrict count,   // [1] or null: params.most
    global const uint*  restrict keys,    // [most]
    global uint*        restrict counts,  // [digits][tiles]
    local ushort*       seen)             // [digits][local size]
{
    uint tile = (uint)get_group_id(0);
    uint items = (uint)get_local_size(0);
    count_digits(keys, digit_run(tile, item_count(params.most, count)), params, seen);
    for (uint digit = (uint)get_local_id(0); digit < 1u << params.bits; digit += items) {
        uint sum = 0;
        for (uint item = 0; item < items; ++item) sum += seen[digit * items + item];
        counts[digit * params.tiles + tile] = sum;
    }
}
