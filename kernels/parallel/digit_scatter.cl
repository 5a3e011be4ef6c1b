// Keys and their payload in the order of one digit, those of equal digits as they were: last of the
// three steps of a sorting pass.
// [Satish09, section 4.1: radix sort by counting, prefix sum and scattering]
//
// A work-item's keys follow those of the work-items before it, and it takes them in order: stable,
// so there is one result, whatever the size of the group.
//
// Work size    1D, one work-group of any size a tile
// Writes       sorted_keys, sorted_payload, of the first *count keys
// Cost         8 bytes read and 8 written a key, 4 read a digit and tile. A tile's keys are read
//              twice, the second time from cache. With digit_counts and the prefix sum a pass costs
//              20 bytes a key and 20 a digit and tile. With 8 bits that is 20 bytes for 16 keys:
//              21.25 bytes a key.
// SPDX-License-Identifier: MIT
#include "parallel/digit.clh"

kernel void parallel_digit_scatter(
    const DigitParams   params,
    global const uint*  restrict count,           // [1] or null: params.most
    global const uint*  restrict offsets,         // [digits][tiles] prefix sum of counts
    global const uint*  restrict keys,            // [most]
    global const uint*  restrict payload,         // [most]
    global uint*        restrict sorted_keys,     // [most]
    global uint*        restrict sorted_payload,  // [most]
    local ushort*       seen,                     // [digits][local size]
    local uint*         begin,                    // [digits]
    local uint*         sums)                     // [local size]
{
    uint tile = (uint)get_group_id(0);
    uint item = (uint)get_local_id(0), items = (uint)get_local_size(0);
    DigitRun run = digit_run(tile, item_count(params.most, count));
    count_digits(keys, run, params, seen);
    // seen becomes how many keys of the tile come before: those of smaller digits, and those of
    // equal digit in earlier runs.
    uint digits = 1u << params.bits;
    uint sum = 0;
    for (uint k = item * digits; k < (item + 1) * digits; ++k) sum += seen[k];
    uint total;
    uint before = group_prefix(sum, sums, &total);
    for (uint k = item * digits; k < (item + 1) * digits; ++k) {
        uint here = seen[k];
        seen[k] = (ushort)before;
        before += here;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint digit = item; digit < digits; digit += items)
        begin[digit] = offsets[digit * params.tiles + tile] - seen[digit * items];
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = run.first; i < run.last; ++i) {
        uint key = keys[i];
        uint digit = digit_of(key, params);
        uint place = begin[digit] + seen[digit * items + item]++;
        sorted_keys[place] = key;
        sorted_payload[place] = payload[i];
    }
}
