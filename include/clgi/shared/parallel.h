// Tools over any number of items: prefix sum, compaction, reductions, sort.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_PARALLEL_H
#define CLGI_SHARED_PARALLEL_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// A tile is what one work-group of any size works on. Its items are cut into leaves of fixed size,
// so that a sum of floats has the same shape, and the same bits, for every size of the group.
enum { PARALLEL_LEAF = 16, PARALLEL_LEAVES = 256, PARALLEL_TILE = PARALLEL_LEAF * PARALLEL_LEAVES };

// The largest number among items that are not NaN, and the first item that has it. -0 equals 0.
typedef struct {
    float value;  // -infinity where index is ARG_MAX_NONE
    uint index;   // ARG_MAX_NONE: every item is NaN, or there is none
    uint nans;    // items that are NaN
    uint pad_;
} ArgMax;

#define ARG_MAX_NONE 0xffffffffu

// The box around items, component by component, NaN left out. -0 is below 0.
typedef struct {
    float4 lower;  // +infinity where no item has a number
    float4 upper;  // -infinity there
    uint nans;     // components that are NaN, of all items
    uint pad0_;
    uint pad1_;
    uint pad2_;
} ItemBounds;

// Planes of 32-bit words, of which some are picked.
typedef struct {
    uint most;  // listed words at most
    uint planes;
    uint stride;      // words from plane to plane, of the planes picked from
    uint out_stride;  // of the planes written
} PickParams;

// One digit of the keys that are sorted.
typedef struct {
    uint most;   // keys at most
    uint tiles;  // of PARALLEL_TILE keys, in `most`
    uint shift;  // lowest bit of the digit
    uint bits;   // of the digit, 0 to DIGIT_BITS
} DigitParams;

enum { DIGIT_BITS = 8 };

CLGI_SHARED_END

#endif
