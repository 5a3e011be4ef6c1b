// What leaves inner elements of one level: the sum of what leaves the elements right below, which are
// done.                                                     [Dachsbacher07, section 3.2]
//
// Work size    1D, one work-item an element of the list, or with CLGI_GROUPS one for every four bins of
//              an element; any local size; tail guarded
// Writes       the rows and powers of its elements
// Cost         4 additions and 16 bytes (half: 8) a bin and element below
// SPDX-License-Identifier: MIT
#include "antiradiance/rows.clh"

kernel void antiradiance_pull(
    const ElementParams params,
    global const uint*    restrict list,      // elements
    global const Element* restrict elements,
    global float4*        restrict powers,    // [elements] area times radiance
    global Intensity*     restrict exitant)   // [rows][CLGI_BINS] over 2^row_exponent
{
#ifdef CLGI_GROUPS
    uint at = (uint)get_global_id(0) / CLGI_FOURS, part = (uint)get_global_id(0) % CLGI_FOURS;
    enum { FOURS = 1 };
#else
    uint at = (uint)get_global_id(0), part = 0;
    enum { FOURS = CLGI_FOURS };
#endif
    if (at >= params.count) return;
    uint element = list[params.first + at];
    uint end = elements[element].end, sends = elements[element].sends;
    if (part == 0) {
        float4 power = (float4)(0.0f);
        for (uint below = element + 1; below < end; below = elements[below].end)
            power += powers[below];
        powers[element] = power;
    }
    if (sends == ELEMENT_NONE) return;
    Bins4 row[FOURS];
    for (uint four = 0; four < FOURS; ++four) row[four] = (Bins4)(0.0f);
    for (uint below = element + 1; below < end; below = elements[below].end) {
        ulong first = (ulong)elements[below].sends * CLGI_FOURS + part;
        Bins4 unit = (Bins4)(
            power_of_two(elements[below].row_exponent - elements[element].row_exponent));
        for (uint four = 0; four < FOURS; ++four)
            row[four] += unit * load_intensities(exitant, first + four);
    }
    ulong first = (ulong)sends * CLGI_FOURS + part;
    for (uint four = 0; four < FOURS; ++four)
        store_intensities(row[four], exitant, first + four);
}
