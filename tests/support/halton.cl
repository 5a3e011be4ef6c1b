// Radical inverses of a list of indices, as the device finds them.
// SPDX-License-Identifier: MIT
#include "clgi/shared/halton.h"

kernel void halton(
    const uint             base,
    global const uint*     restrict indices,  // [items]
    global float*          restrict values)   // [items]
{
    values[get_global_id(0)] = radical_inverse(indices[get_global_id(0)], base);
}
