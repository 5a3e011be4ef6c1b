// Light and visibility in spherical harmonics (clgi/advanced/sh.hpp has the conventions).
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_TRANSFER_H
#define CLGI_SHARED_TRANSFER_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// Bands are a build option of the room's kernels: CLGI_SH_BANDS.
enum { SH_MOST_BANDS = 9, SH_DEFAULT_BANDS = 5 };

// Where the order m >= 0 of degree l lies among those of all degrees.
#define SH_MOMENT(l, m) ((l) * ((l) + 1) / 2 + (m))

// Waves of an angle: 1, cos a, sin a, cos 2a, sin 2a ... up to the last band's degree.
#define SH_WAVES(bands) (2 * (bands) - 1)

// How an environment's picture is cut for its projection. Sums have the same order for every size
// of a work-group and every width of packets, because these numbers are fixed.
enum {
    PROJECT_RUN = 16,                 // items summed one after the other
    PROJECT_ROWS = 128,               // rows of a block: runs of them
    PROJECT_LANES = 48,               // floats added at a time: 16 texels
    PROJECT_LEAF = 8 * PROJECT_LANES, // floats of a row that make one leaf
    PROJECT_FEW = 2                   // orders that a work-item sums on a GPU, which has little room
};

typedef struct {
    float4 factor;     // times the picture: exposed radiance, rgb
    uint width;        // texels
    uint height;
    uint stride;       // floats of a row, rounded up to whole leaves
    uint light_count;  // directional lights that are added
} ProjectParams;

// What arrives at receivers where nothing blocks the light.
typedef struct {
    float cosine[12];  // of each band, l = 0 to bands - 1: the clamped cosine's A_l, windowed
    uint receiver_count;
    uint stride;  // of the planes and the irradiance
    uint normal;  // the first of three planes: RECEIVER_NORMAL, or GBUFFER_NORMAL
    uint flags;   // SHADE_... (clgi/shared/masks.h)
} OpenParams;

// A light from one direction, in the frame of the coefficients.
typedef struct {
    float4 direction;   // xyz: unit, towards the light; w: 0
    float4 irradiance;  // rgb: exposed, of a plane that faces it; w: 0
} DirectionalLight;

CLGI_SHARED_END

#endif
