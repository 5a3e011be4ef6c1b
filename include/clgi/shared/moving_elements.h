// Elements that move, and the links that end at or begin at one.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_MOVING_ELEMENTS_H
#define CLGI_SHARED_MOVING_ELEMENTS_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// Where an element is, in the local frame.
typedef struct {
    float4 position;  // w: radius of the sphere that holds its subtree in all poses; 0: a leaf
    float4 normal;    // unit; zero: a cluster that is not flat, or a patch that has none;
                      // w: DirectionBins::hemisphere_scale
    float area;
    uint triangle;  // of the device; ELEMENT_NONE: a cluster
    int row_exponent;  // as in Element
    uint pad1_;
} ElementPlace;

// A link whose bin and form factor follow its ends is two words: which link, and its receiver with a
// part of the sender's triangle above PART_SHIFT: all of it, one of its quarters, or one of their
// quarters. Quarters are those at the corners, then the middle one.
#define PART_SHIFT 27u  // there are fewer elements than that has bits
#define PART_WHOLE 0u
#define PART_QUARTERS 1u
#define PART_SIXTEENTHS 5u  // of the first quarter the first
#define PART_END 21u

typedef struct {
    uint count;          // of moving links
    float least_cosine;  // of a link's direction with its bin
    uint pad0_;
    uint pad1_;
} RelinkParams;

CLGI_SHARED_END

#endif
