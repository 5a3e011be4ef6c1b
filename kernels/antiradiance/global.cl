// Light that arrives at inner elements of one level: what links bring, and what is pushed down from
// the level above, which is done.               [Dachsbacher07, section 3.1, Eq. 16; section 4.2]
//
// Work size    1D, one work-item an element of the list; any local size; tail guarded
// Writes       the rows of its elements
// Cost         CLGI_BINS moves of 16 bytes; a link 4 multiply-adds and, at random, 16 bytes (half: 8)
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
    float4 row[CLGI_BINS];
    receive(element, of, incident, row);
    global float4* out = incident + (ulong)elements[element].row * CLGI_BINS;
    for (uint bin = 0; bin < CLGI_BINS; ++bin) out[bin] = row[bin];
}
