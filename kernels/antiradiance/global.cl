// Light that arrives at inner elements of one level: what links bring, and what is pushed down from
// the level above, which is done.               [Dachsbacher07, section 3.1, Eq. 16; section 4.2]
//
// Work size    1D, one work-item an element of the list; any local size; tail guarded
// Writes       the rows of its elements
// Cost         CLGI_BINS moves of 16 bytes; a link 4 multiply-adds, 10 bytes in order and 16 at random:
//              of what lies before a plane from a table that stays in the cache, else from rows (half: 8)
// SPDX-License-Identifier: MIT
#include "antiradiance/rows.clh"

kernel void antiradiance_global(
    const ElementParams params,
    global const uint*    restrict list,      // elements
    LINK_ARGUMENTS,
    global float4*        restrict incident)  // [inner elements][CLGI_BINS] radiance
{
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    LinkedElements of = LINKS;
    Bins4 row[CLGI_FOURS];
    receive(element, of, incident, row);
    global float* out = (global float*)(incident + (ulong)elements[element].row * CLGI_BINS);
    for (uint four = 0; four < CLGI_FOURS; ++four) vstore16(row[four], four, out);
}
