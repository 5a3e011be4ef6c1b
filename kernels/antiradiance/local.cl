// Light that arrives at leaves, and what leaves them: reflected radiance before them, antiradiance
// behind.                                        [Dachsbacher07, Eq. 13, 14, 16, 18 and 19]
//
//   I_ex(j) = a c_j (c_j > 0 ? L : L_in(j)),   c_j = n.w_j,
//   L = source + rho / pi E,                   E = sum of w_j max(0, -c_j) L_in(j)
//
// Normals are scaled so that cosines times solid angles of a hemisphere add up to pi exactly: what
// is reflected and what is let through is what arrives.              [derived: sum over the bins]
//
// Work size    1D, one work-item a leaf of the list; any local size; tail guarded
// Writes       of its leaves: intensities, power, radiance, irradiance, and how it changed. Numbers that
//              are not finite stay so and are counted
// Cost         that of antiradiance.global, and 36 operations and 16 bytes (half: 8) a bin
// SPDX-License-Identifier: MIT
#include "antiradiance/leaf.clh"

kernel void antiradiance_local(
    const ElementParams params,
    global const uint*    restrict list,         // leaves
    LINK_ARGUMENTS,
    global const float4*  restrict incident,     // [inner elements][CLGI_BINS] radiance
    global const float4*  restrict directions,   // [CLGI_BINS] unit; w: sr
    LEAF_ARGUMENTS,
    global float4*        restrict next_powers,  // [elements] area times radiance
    global Intensity*     restrict next)         // [rows][CLGI_BINS] over 2^row_exponent
{
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    Element leaf = elements[element];
    LinkedElements of = LINKS;
    Bins4 row[CLGI_FOURS];
    receive_at_leaf(element, of, incident, params.step, row);
    float4 arrived = irradiance_of(leaf, directions, row);
    note_irradiance(leaf, arrived, irradiances, changes);
    if (!is_finite3(arrived.xyz)) atomic_inc(non_finite);
    float4 radiance =
        reflect_diffuse(leaf, params.step, arrived, sources, reflectances, radiances);
    next_powers[element] = leaf.normal.w * radiance;
    if (leaf.sends == ELEMENT_NONE) return;
    for (uint four = 0; four < CLGI_FOURS; ++four)
        send_bins(leaf, params.step, four, row[four], radiance, directions, exitant, next);
}
