// The form of gloss for groups: a leaf belongs to a group, and each lane has a bin of every `lanes`, with
// its opposite. Sums have the order of gloss.                            [derived: as gloss.cl]
//
// Work size    1D, one group a glossy leaf; at most 64 lanes a group
// Writes       as gloss
// SPDX-License-Identifier: MIT
#include "antiradiance/glossy.clh"
#include "antiradiance/leaf_group.clh"
#include "antiradiance/lobe_group.clh"

kernel void antiradiance_gloss_group(GLOSS_ARGUMENTS) {
    local LeafRow received;
    local SharedFront front;
    local float light[3][HALF_BINS];  // of the bins below, as lobes take it
    local float4 diffuse;
    local uint bad;
    uint at = (uint)get_group_id(0), lane = (uint)get_local_id(0), lanes = (uint)get_local_size(0);
    if (at >= params.count) return;
    uint element = glossy[at].element;
    Element leaf = elements[element];
    LinkedElements of = LINKS;
    float4 arrived = receive_leaf_in_group(element, leaf, of, incident, directions, params.step, lane,
                                           lanes, &received);
    local float4* bins_of_row = (local float4*)received.row;
    float exponent = glossy[at].exponent;
    if (lane == 0) {
        note_irradiance(leaf, arrived, irradiances, changes);
        diffuse = reflect_diffuse(leaf, params.step, arrived, sources, reflectances, radiances);
        next_powers[element] = (float4)(0.0f);
        bad = !(is_finite3(arrived.xyz) && lobe_is_number(exponent));
    }
    float area = leaf.normal.w * power_of_two(-leaf.row_exponent);
    float3 normal = leaf.normal.xyz, unit = front_unit(normal);
    int sends = leaf.sends != ELEMENT_NONE, reflects = (params.step & LOCAL_REFLECT) != 0;
    ulong first = sends ? (ulong)leaf.sends * CLGI_BINS : 0;
    global const float* factor = factors + (ulong)at * CLGI_BINS;
    if (reflects) {
        find_shared_front(normal, unit, planes, lane, lanes, &front);
        for (uint k = lane; k < HALF_BINS; k += lanes) {
            uint from = bin_below(front_packet(normal, unit, planes, k).turned, k);
            float4 flux = factor[from] * front.projected[k] * bins_of_row[from];
            light[0][k] = flux.x;
            light[1][k] = flux.y;
            light[2][k] = flux.z;
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    // From here on the row has what leaves.
    global float* shown = arriving + (ulong)at * 3 * ROW_BINS;
    for (uint bin = lane; bin < CLGI_BINS; bin += lanes) {
        float cosine = dot(normal, directions[bin].xyz);
        float4 arrives = bins_of_row[bin], in = cosine < 0.0f ? arrives : (float4)(0.0f);
        shown[bin] = in.x;
        shown[ROW_BINS + bin] = in.y;
        shown[2 * ROW_BINS + bin] = in.z;
        bins_of_row[bin] = params.step & LOCAL_GO_THROUGH && cosine <= 0.0f ? cosine * area * arrives
                           : sends ? load_intensity(exitant, first + bin)
                                   : (float4)(0.0f);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    global const float* source = gloss_sources + (ulong)at * 3 * ROW_BINS;
    for (uint k = lane; reflects && k < HALF_BINS; k += lanes) {
        FrontPacket above = front_packet(normal, unit, planes, k);
        float4 made = (float4)(light[0][k], light[1][k], light[2][k], 0.0f);
        if (params.step & LOCAL_RECEIVE) {
            made = (float4)(0.0f);
            for (uint l = 0; l < HALF_BINS; ++l) {
                float share = shared_lobe(&above, &front, l, lobe_exponent(exponent));
                made.x = fma(share, light[0][l], made.x);
                made.y = fma(share, light[1][l], made.y);
                made.z = fma(share, light[2][l], made.z);
            }
        }
        uint bin = bin_above(above.turned, k);
        float4 own = (float4)(source[bin], source[ROW_BINS + bin], source[2 * ROW_BINS + bin], 0.0f);
        float4 leaving = diffuse + fma(colors[at] * factor[bin], made, own);
        if (!is_finite3(leaving.xyz)) atomic_or(&bad, 1u);
        bins_of_row[bin] = above.cosine * area * leaving;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint four = lane; sends && four < CLGI_FOURS; four += lanes)
        store_intensities(received.row[four], next, first / 4 + four);
    if (lane == 0 && bad) atomic_inc(non_finite);
}
