// Receivers at pixels of a picture, and what arrives at receivers brought to pixels.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_RECEIVERS_H
#define CLGI_SHARED_RECEIVERS_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// The other sides of some receivers, behind all that have been made.
typedef struct {
    uint first;   // receiver that the first one becomes
    uint count;
    uint stride;  // of the planes of receivers
    uint pad0_;
} SidesParams;

#define RECEIVER_NONE 0xffffffffu

// A run of a list of pixels, as receivers 0 to count - 1.
typedef struct {
    uint first;         // place in the list
    uint count;
    uint pixel_stride;  // of the planes of pixels
    uint stride;        // of the planes of receivers and what arrives at them
    float lift;         // from the surface to the receiver, local frame
    uint pad0_;
    uint pad1_;
    uint pad2_;
} PixelParams;

// Receivers 0 to vertex_count - 1 are the vertices of the scene.
typedef struct {
    float4 eye;             // xyz: local frame; w: 1: the direction to the eye, everywhere
    uint pixel_count;
    uint pixel_stride;      // of the planes of pixels
    uint triangle_count;
    uint receiver_stride;   // of what arrives at receivers
} ShowVerticesParams;

// Probes are the pixels (step / 2 + i step, step / 2 + j step).
typedef struct {
    uint width;  // pixels
    uint height;
    uint pixel_stride;
    uint probe_stride;  // of what arrives at the probes
    uint step;          // pixels between probes
    uint columns;       // probes of a row: (width - step / 2 + step - 1) / step
    uint rows;
    float threshold;    // of the difference, of the larger value
} ProbeParams;

enum {
    PROBE_NOWHERE = 0,  // no surface is seen
    PROBE_AGREES = 1,
    PROBE_FAILS = 2     // what is shown differs by more than the threshold
};

typedef struct {
    uint pixel_count;
    uint pixel_stride;
    float exposure;  // multiplies the light: undoes the scene's exposure
    uint pad0_;
} AddGlossParams;

// Light that triangles reflect to receivers.
typedef struct {
    uint triangle_count;   // of the triangles that block
    uint receiver_stride;  // of what arrives at vertices and other sides
    float per_pixel;       // pi / pixels of a mask
    uint pad0_;
} BounceParams;

CLGI_SHARED_END

#endif
