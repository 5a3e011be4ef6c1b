// The form of global for groups: an element belongs to a group, and its row is in local memory.
// [derived: as global.cl]
//
// Work size    1D, one group an element of the list; at most 64 lanes a group
// Writes       the rows of its elements
// SPDX-License-Identifier: MIT
#include "antiradiance/rows_group.clh"

kernel void antiradiance_global_group(
    const ElementParams params,
    global const uint*    restrict list,      // elements
    LINK_ARGUMENTS,
    global float4*        restrict incident)  // [inner elements][CLGI_BINS] radiance
{
    local LinkChunk chunk;
    local float4 row[CLGI_BINS];
    uint at = (uint)get_group_id(0), lane = (uint)get_local_id(0), lanes = (uint)get_local_size(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    LinkedElements of = LINKS;
    receive_in_group(element, of, incident, lane, lanes, &chunk, row);
    global float4* out = incident + (ulong)elements[element].row * CLGI_BINS;
    for (uint bin = lane; bin < CLGI_BINS; bin += lanes) out[bin] = row[bin];
}
