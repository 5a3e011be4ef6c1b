// What leaves inner elements of one level: the sum of what leaves the elements right below, which are
// done.                                                     [Dachsbacher07, section 3.2]
//
// Work size    1D, one work-item an element of the list; any local size; tail guarded
// Writes       the rows and powers of its elements
// Cost         4 additions and 16 bytes (half: 8) a bin and element below
// SPDX-License-Identifier: MIT
#include "antiradiance/rows.clh"

kernel void antiradiance_pull(
    const ElementParams params,
    global const uint*    restrict list,      // elements
    global const Element* restrict elements,
    global float4*        restrict powers,    // [elements] area times radiance
    global Intensity*     restrict exitant)   // [elements][CLGI_BINS]
{
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    uint end = elements[element].end;
    Bins4 row[CLGI_FOURS];
    for (uint four = 0; four < CLGI_FOURS; ++four) row[four] = (Bins4)(0.0f);
    float4 power = (float4)(0.0f);
    for (uint below = element + 1; below < end; below = elements[below].end) {
        power += powers[below];
        ulong first = (ulong)below * CLGI_FOURS;
        for (uint four = 0; four < CLGI_FOURS; ++four)
            row[four] += load_intensities(exitant, first + four);
    }
    powers[element] = power;
    ulong first = (ulong)element * CLGI_FOURS;
    for (uint four = 0; four < CLGI_FOURS; ++four)
        store_intensities(row[four], exitant, first + four);
}
