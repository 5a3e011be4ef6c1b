// The form of local for groups: a leaf belongs to a group, and its row is in local memory. Sums of
// irradiance have the order of local, each by one lane.                  [derived: as local.cl]
//
// Work size    1D, one group a leaf of the list; at most 64 lanes a group
// Writes       as local
// SPDX-License-Identifier: MIT
#include "antiradiance/leaf.clh"
#include "antiradiance/rows_group.clh"

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
    local LinkChunk chunk;
    local Bins4 row[CLGI_FOURS];
    local float before[CLGI_BINS], sums[16];
    local float4 leaves;
    uint at = (uint)get_group_id(0), lane = (uint)get_local_id(0), lanes = (uint)get_local_size(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    Element leaf = elements[element];
    LinkedElements of = LINKS;
    if (params.step & LOCAL_RECEIVE)
        receive_in_group(element, of, incident, lane, lanes, &chunk, (local float4*)row);
    else
        for (uint four = lane; four < CLGI_FOURS; four += lanes) row[four] = (Bins4)(0.0f);
    for (uint four = lane; four < CLGI_FOURS; four += lanes)
        vstore4(bins_before(leaf, four, directions).s048c, four, before);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint k = lane; k < 16; k += lanes) {
        local const float* arriving = (local const float*)row + k;
        float sum = 0.0f;
        for (uint four = 0; four < CLGI_FOURS; ++four) {
            float share = before[4 * four + k / 4];
            sum = fma(share, share > 0.0f ? arriving[16 * four] : 0.0f, sum);
        }
        sums[k] = sum;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (lane == 0) {
        float4 arrived = sum_of_bins(vload16(0, sums));
        note_irradiance(leaf, arrived, irradiances, changes);
        if (!is_finite3(arrived.xyz)) atomic_inc(non_finite);
        leaves = reflect_diffuse(leaf, params.step, arrived, sources, reflectances, radiances);
        next_powers[element] = leaf.normal.w * leaves;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (leaf.sends == ELEMENT_NONE) return;
    for (uint four = lane; four < CLGI_FOURS; four += lanes)
        send_bins(leaf, params.step, four, row[four], leaves, directions, exitant, next);
}
