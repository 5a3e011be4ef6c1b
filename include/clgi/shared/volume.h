// Irradiance at the points of a grid in space, in twelve directions each, and what it comes to at
// any place and for any normal.
//
// The directions are the corners of an icosahedron, over which the mean of every polynomial of up
// to degree 5 is its mean over the sphere. Irradiance is all but a polynomial of degree 2 of the
// normal [Ramamoorthi01], so its projection onto spherical harmonics of three bands is
//
//   E(n) = sum_i w(n . n_i) E(n_i),   w(c) = (1 + 3 c + 5 (3 c^2 - 1) / 2) / 12
//
// the sum over bands l of (2 l + 1) P_l(c) / 12.          [Greger98; derived: spherical 5-design]
//
// A point also has the distances of the nearest surfaces around it, so that what a wall hides from
// it does not take its light: their mean and the mean of their squares in the texels of an
// octahedral map.                                                   [Majercik19]
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_VOLUME_H
#define CLGI_SHARED_VOLUME_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// A direction (x, y, z) is at (x, y) / (|x| + |y| + |z|) in a map over [-1, 1]^2, folded outward
// over |x| + |y| = 1 where z < 0. A border one texel wide goes on where the map does beyond its
// sides, for interpolation.
enum {
    VOLUME_DIRECTIONS = 12,
    VOLUME_SIDE = 16,                         // texels along a side of a map of distances
    VOLUME_ROW = VOLUME_SIDE + 2,             // with the border
    VOLUME_TEXELS = VOLUME_ROW * VOLUME_ROW,  // of a map
};

// Spacings beyond which distances are not told apart: more than between a place and those points
// around it that count noticeably.
#define VOLUME_RANGE 2.0f

// Coordinates of a corner of an icosahedron in the unit sphere: one is 0, the next of x, y, z, x, y
// is +-VOLUME_SHORT, the one after it +-VOLUME_LONG.
#define VOLUME_SHORT 0.525731112f
#define VOLUME_LONG 0.850650808f

// Points of surfaces that a volume lights.
typedef struct {
    float4 origin;  // xyz: of the grid's first point, local frame; w: points per local unit
    uint point_count;
    uint stride;  // of the G-buffer's planes and of the irradiance
    uint triangle_count;
    uint columns;  // points of the grid along x, y and z
    uint rows;
    uint layers;
    uint first;         // of the grid's irradiance in a plane of light
    uint light_stride;  // of the planes of light
    uint open_count;    // points of the grid that have light
    uint pad_[3];
} VolumeParams;

CLGI_SHARED_END

#endif
