// Factors that keep the energy of lobes between bins: light of a bin l leaves along a bin j with
//
//   f(l, j) = in(l) out(j) max(0, m_l . w_j)^n,   m_l: minus w_l, mirrored at the surface
//
// out: such that as nearly as a few rounds bring it every bin of arriving light, and every bin of
// leaving light, has the lobe's albedo; in: such that arriving bins have it exactly. f is then
// nearly the same both ways, as the lobe is.
// [derived: symmetric scaling of Sinkhorn and Knopp, Concerning nonnegative matrices, 1967]
//
// Work size    1D, one work-item a glossy leaf; any local size; tail guarded
// Writes       the factors of its leaf: out at bins above the surface, in at their opposites.
//              NaN for an exponent that is NaN
// Cost         LOBE_ROUNDS + 1 times 33 operations for every pair of bins above the surface
// SPDX-License-Identifier: MIT
#include "antiradiance/glossy.clh"

// Of what arrives along all bins, weighted by projected solid angles times `out`.
CLGI_INLINE void weigh(const Front* front, float exponent, const float* out, float* sums) {
    for (uint j = 0; j < FRONT_BINS; j += CLGI_WIDTH) {
        floatp x = packet_load(front->x + j), y = packet_load(front->y + j),
               z = packet_load(front->z + j), sum = packet_zero;
        for (uint l = 0; l < HALF_BINS; ++l)
            sum = fma(lobe_toward(x, y, z, front->mx[l], front->my[l], front->mz[l], exponent),
                      packet_splat(front->projected[l] * out[l]), sum);
        packet_store(sum, sums + j);
    }
}

kernel void antiradiance_lobes(LOBES_ARGUMENTS) {
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    GlossyLeaf leaf = leaves[at];
    float3 normal = elements[leaf.element].normal.xyz;
    float exponent = lobe_exponent(leaf.exponent);
    global const float* of = albedos + leaf.material * (ALBEDO_STEPS + 1);
    Front front;
    find_front(normal, bins, &front);
    float scale = front_scale(normal);
    float wanted[FRONT_BINS], out[FRONT_BINS], sums[FRONT_BINS];
    for (uint k = 0; k < HALF_BINS; ++k) {
        wanted[k] = lobe_albedo(of, front.cosine[k] * scale);
        out[k] = 1.0f;
    }
    for (int round = 0; round < LOBE_ROUNDS; ++round) {
        weigh(&front, exponent, out, sums);
        for (uint k = 0; k < HALF_BINS; ++k)
            out[k] = lobe_rescaled(out[k], wanted[k], sums[k]);
    }
    weigh(&front, exponent, out, sums);
    global float* row = factors + (ulong)at * CLGI_BINS;
    for (uint k = 0; k < HALF_BINS; ++k) {
        row[bin_above(front.turned[k], k)] = out[k];
        row[bin_below(front.turned[k], k)] = lobe_share(wanted[k], sums[k]);
    }
}
