// Blocked directions of a hemisphere as bits, and what is needed to draw them.
//
// A mask is a grid of R x R pixels over the unit disc, to which the hemisphere above a receiver is
// projected along its normal [Kautz04, section 3.1]. The pixel of column i and row j stands for the
// direction (x, y, sqrt(1 - x^2 - y^2)) of its centre, x = (2 i + 1) / R - 1, y = (2 j + 1) / R - 1,
// in the receiver's frame (tangent, bitangent, normal). Pixels whose centre lies outside the disc
// are 0 in every mask.
// A word of a mask is a column: its bits are 32 rows, the lowest bit first.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_MASKS_H
#define CLGI_SHARED_MASKS_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// Columns that a mask of this size has room for, whole packets of any width.
#define MASK_COLUMNS(size) ((size) < 16 ? 16 : (size))
#define MASK_ROW_WORDS(size) (((size) + 31) / 32)
#define MASK_WORDS(size) (MASK_COLUMNS(size) * MASK_ROW_WORDS(size))

// Planes of the receivers.
enum {
    RECEIVER_POSITION = 0,
    RECEIVER_TANGENT = 3,    // x of the mask
    RECEIVER_BITANGENT = 6,  // y of the mask
    RECEIVER_NORMAL = 9,     // z; the three are unit, at right angles and right-handed
    RECEIVER_PLANES = 12
};

// Triangles that block: planes of their corners, and a box around each 64 of them.
enum { BLOCKER_CLUSTER = 64, BLOCKER_PLANES = 9 };

typedef struct {
    float4 low;   // xyz; w: 0
    float4 high;  // xyz; w: 0
} BlockerBox;

// What goes wrong with the input, words of a status buffer.
enum {
    MASK_BAD_RECEIVERS = 0,  // a number that is not finite, or a normal without direction
    MASK_BAD_BLOCKERS = 1,   // triangles with a number that is not finite; they block nothing
    MASK_STATUS_WORDS = 2
};

typedef struct {
    uint triangle_count;
    uint stride;  // of the planes of corners: whole clusters
    uint pad0_;
    uint pad1_;
} BlockerParams;

typedef struct {
    uint receiver_count;
    uint stride;  // of the planes of receivers
    uint pad0_;
    uint pad1_;
} ReceiverParams;

typedef struct {
    uint receiver_count;
    uint receiver_stride;    // of the planes of receivers, and of the words of masks
    uint blocker_stride;     // of the planes of corners
    uint receivers_per_list; // consecutive receivers that share a list of clusters
    uint table_size;         // Q, with a table of planes
    uint pad0_;
    uint pad1_;
    uint pad2_;
} MaskParams;

typedef struct {
    float4 eye;  // for gloss; xyz: local frame; w: 1: the direction to the eye, everywhere
    uint receiver_count;
    uint stride;  // of the planes of receivers, the words of masks and the transfer vectors
    uint pad0_;
    uint pad1_;
} IntegrateParams;

typedef struct {
    uint receiver_count;
    uint stride;  // of the transfer vectors and the irradiance
    uint flags;   // SHADE_...
    uint pad0_;
} ShadeParams;

enum { SHADE_CLAMP = 1 };  // nothing is negative

CLGI_SHARED_END

#endif
