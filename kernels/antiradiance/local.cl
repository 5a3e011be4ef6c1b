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
// Writes       of its leaves: intensities, radiance, irradiance, and how it changed. Numbers that
//              are not finite stay so and are counted
// Cost         that of antiradiance.global, and 17 operations and 16 bytes (half: 8) a bin
// SPDX-License-Identifier: MIT
#include "antiradiance/rows.clh"
#include "finite.clh"

kernel void antiradiance_local(
    const ElementParams params,
    global const uint*    restrict list,         // leaves
    LINK_ARGUMENTS,
    global const float4*  restrict incident,     // [inner elements][CLGI_BINS] radiance
    global const float4*  restrict directions,   // [CLGI_BINS] unit; w: sr
    global const float4*  restrict sources,      // [leaves] rgb radiance that no pass brings
    global const float4*  restrict reflectances, // [leaves] rgb
    global float4*        restrict radiances,    // [leaves] rgb that leaves
    global float4*        restrict irradiances,  // [leaves] rgb that arrived
    global float4*        restrict changes,      // [leaves] rgb: watts by which it changed; w: its watts
    global uint*          restrict non_finite,   // [1] leaves whose irradiance is not finite
    global Intensity*     restrict next)         // [elements][CLGI_BINS] intensities
{
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    Element leaf = elements[element];
    LinkedElements of = LINKS;
    float4 row[CLGI_BINS];
    if (params.step & LOCAL_RECEIVE)
        receive(element, of, incident, row);
    else
        for (uint bin = 0; bin < CLGI_BINS; ++bin) row[bin] = (float4)(0.0f);

    float4 arrived = (float4)(0.0f);
    for (uint bin = 0; bin < CLGI_BINS; ++bin) {
        float4 w = directions[bin];
        float cosine = dot(leaf.normal.xyz, w.xyz);
        if (cosine < 0.0f) arrived = fma((float4)(-cosine * w.w), row[bin], arrived);
    }
    float4 change = fabs(arrived - irradiances[leaf.row]) * leaf.normal.w;
    change.w = (fabs(arrived.x) + fabs(arrived.y) + fabs(arrived.z)) * leaf.normal.w;
    changes[leaf.row] = change;
    irradiances[leaf.row] = arrived;
    if (!is_finite3(arrived.xyz)) atomic_inc(non_finite);

    float4 radiance = radiances[leaf.row];
    if (params.step & LOCAL_REFLECT) {
        radiance = fma(reflectances[leaf.row] * (1.0f / CLGI_PI), arrived, sources[leaf.row]);
        radiances[leaf.row] = radiance;
    }
    ulong first = (ulong)element * CLGI_BINS;
    for (uint bin = 0; bin < CLGI_BINS; ++bin) {
        float cosine = dot(leaf.normal.xyz, directions[bin].xyz);
        float4 scale = (float4)(cosine * leaf.normal.w);
        float4 leaving = scale * radiance;
        if (cosine <= 0.0f)
            leaving = params.step & LOCAL_GO_THROUGH ? scale * row[bin]
                                                   : load_intensity(exitant, first + bin);
        store_intensity(leaving, next, first + bin);
    }
}
