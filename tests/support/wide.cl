// Sums in wide.clh, one a work-item, for comparison with the host's doubles.
// SPDX-License-Identifier: MIT
#include "scene/wide.clh"

kernel void wide_sums(
    global const ulong* restrict first,   // [sums] bits of doubles
    global const ulong* restrict second,  // [sums]
    global const uint*  restrict narrow,  // [sums] bits of floats
    const int scale,
    global ulong*       restrict sums,     // first + second
    global ulong*       restrict widened,  // first + narrow
    global uint*        restrict rounded)  // first times 2^scale as a float
{
    uint i = (uint)get_global_id(0);
    sums[i] = wide_add(first[i], second[i]);
    widened[i] = wide_add(first[i], wide_from_float(narrow[i]));
    rounded[i] = wide_to_float(first[i], scale);
}
