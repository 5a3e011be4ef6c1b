// The form of local for groups: a leaf belongs to a group, and its row is in local memory.
//                                                                         [derived: as local.cl]
//
// Work size    1D, one group a leaf of the list; at most 64 lanes a group
// Writes       as local
// SPDX-License-Identifier: MIT
#include "antiradiance/leaf_group.clh"

kernel void antiradiance_local_group(
    const ElementParams params,
    global const uint*    restrict list,         // leaves
    LINK_ARGUMENTS,
    global const float4*  restrict incident,     // [inner elements][CLGI_BINS] radiance
    global const float4*  restrict directions,   // [CLGI_BINS] unit; w: sr
    LEAF_ARGUMENTS,
    global float4*        restrict next_powers,  // [elements] area times radiance
    global Intensity*     restrict next)         // [rows][CLGI_BINS] over 2^row_exponent
{
    local LeafRow received;
    local float4 leaves;
    uint at = (uint)get_group_id(0), lane = (uint)get_local_id(0), lanes = (uint)get_local_size(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    Element leaf = elements[element];
    LinkedElements of = LINKS;
    float4 arrived = receive_leaf_in_group(element, leaf, of, incident, directions, params.step, lane,
                                           lanes, &received);
    if (lane == 0) {
        note_irradiance(leaf, arrived, irradiances, changes);
        if (!is_finite3(arrived.xyz)) atomic_inc(non_finite);
        leaves = reflect_diffuse(leaf, params.step, arrived, sources, reflectances, radiances);
        next_powers[element] = leaf.normal.w * leaves;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (leaf.sends == ELEMENT_NONE) return;
    for (uint four = lane; four < CLGI_FOURS; four += lanes)
        send_bins(leaf, params.step, four, received.row[four], leaves, directions, exitant, next);
}
