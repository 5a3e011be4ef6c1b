// The form of lobes for groups: a leaf belongs to a group, and each lane has a bin of every `lanes`.
// Sums have the order of lobes.                                          [derived: as lobes.cl]
//
// Work size    1D, one group a glossy leaf; any number of lanes
// Writes       as lobes
// SPDX-License-Identifier: MIT
#include "antiradiance/lobe_group.clh"
#include "antiradiance/glossy.clh"

kernel void antiradiance_lobes_group(LOBES_ARGUMENTS) {
    local SharedFront front;
    local float out[HALF_BINS], sums[HALF_BINS];
    uint at = (uint)get_group_id(0), lane = (uint)get_local_id(0), lanes = (uint)get_local_size(0);
    if (at >= params.count) return;
    GlossyLeaf leaf = leaves[at];
    float3 normal = elements[leaf.element].normal.xyz, unit = front_unit(normal);
    float exponent = lobe_exponent(leaf.exponent);
    global const float* of = albedos + leaf.material * (ALBEDO_STEPS + 1);
    float scale = front_scale(normal);
    find_shared_front(normal, unit, bins, lane, lanes, &front);
    for (uint k = lane; k < HALF_BINS; k += lanes) out[k] = 1.0f;
    global float* row = factors + (ulong)at * CLGI_BINS;
    for (int round = 0; round <= LOBE_ROUNDS; ++round) {
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint k = lane; k < HALF_BINS; k += lanes) {
            FrontPacket bin = front_packet(normal, unit, bins, k);
            float sum = 0.0f;
            for (uint l = 0; l < HALF_BINS; ++l)
                sum = fma(shared_lobe(&bin, &front, l, exponent), front.projected[l] * out[l], sum);
            sums[k] = sum;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint k = lane; k < HALF_BINS; k += lanes) {
            FrontPacket bin = front_packet(normal, unit, bins, k);
            float wanted = lobe_albedo(of, bin.cosine * scale);
            if (round < LOBE_ROUNDS) {
                out[k] = lobe_rescaled(out[k], wanted, sums[k]);
            } else {
                row[bin_above(bin.turned, k)] = out[k];
                row[bin_below(bin.turned, k)] = lobe_share(wanted, sums[k]);
            }
        }
    }
}
