// The first N candidates inside the cone, in index order.        [Cochran07, section 3.1]
//
// Work size    one work-group of any size; each work-item takes a run of mask words
// Writes       accepted[first_vpl .. + vpl_count) of its emitter; candidates that were not
//              found (the cone is narrower than the candidates are dense) stay 0
// SPDX-License-Identifier: MIT
#include "compact.clh"
#include "clgi/shared/lights.h"

kernel void lights_accept_list(
    const AcceptParams     params,
    global const Emitter*  restrict emitters,  // [emitter_count]
    global const uint*     restrict mask,      // [candidate_count / 32]
    global uint*           restrict accepted,  // [vpl_count] Halton index, 0: none
    local uint*            sums)               // [local size]
{
    uint words = params.candidate_count / 32;
    uint items = (uint)get_local_size(0);
    uint run = (words + items - 1) / items;
    uint first = min((uint)get_local_id(0) * run, words);
    uint last = min(first + run, words);

    uint count = 0;
    for (uint word = first; word < last; ++word) count += popcount(mask[word]);
    uint total;
    uint place = group_prefix(count, sums, &total);

    uint first_vpl = emitters[params.emitter].first_vpl;
    uint wanted = emitters[params.emitter].vpl_count;
    for (uint word = first; word < last && place < wanted; ++word) {
        uint bits = mask[word];
        for (uint k = 0; k < 32 && place < wanted; ++k)
            if (bits >> k & 1) accepted[first_vpl + place++] = word * 32 + k + 1;
    }
    for (uint rest = total + (uint)get_local_id(0); rest < wanted; rest += items)
        accepted[first_vpl + rest] = 0;
}
