// Light sources as they are sampled, and the indirect lights that come of it.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_LIGHTS_H
#define CLGI_SHARED_LIGHTS_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

enum { EMITTER_SPOT = 0, EMITTER_POINT = 1, EMITTER_DIRECTIONAL = 2, EMITTER_AREA = 3 };

// Added to the kind of a spot too narrow for rejection: its cone is mapped directly.
enum { EMITTER_KIND = 3, EMITTER_MAPPED = 4 };

// One source of direct light: a lamp, or one sample of the emissive surfaces.
typedef struct {
    float4 position;   // xyz; directional: centre of the lit disc
    float4 axis;       // xyz unit: spot axis, light direction, surface normal; w: cos(outer angle)
    float4 right;      // xyz unit, completes a frame with axis; w: cos(inner angle)
    float4 intensity;  // rgb: candela; directional lux; area: flux, lumen. All exposed
    float4 shift;      // of the low-discrepancy points: bases 2, 3, 5, 7; each in [0,1)
    float range;       // where the light ends; 0: unlimited
    float measure;     // what the samples share: steradians; directional: area of the disc; area:
                       // projected steradians, this emitter's part of what all area lights share
    float area;        // area lights: of the emitting surface that this sample stands for;
                       // directional: of the disc, for one indirect light of all that share it
    uint kind;         // EMITTER_..., EMITTER_MAPPED
    uint first_view;   // its images of the scene: 1 (spot, directional), 5 (area) or 6 (point)
    uint view_count;
    uint first_light;  // its share of the indirect lights
    uint light_count;
    uint first_index;  // of its points in their sequence, at least 1: all directions of an
                       // environment go on along one, and all samples of the emissive surfaces
    float taken_over;  // multiplies the flux of its indirect lights: sources too weak to have a
                       // light leave theirs to the others; 1 where all have some
    uint pad0_;
    uint pad1_;
} Emitter;

// A point light with a cosine lobe, standing for a disc around it: the irradiance it gives is
// flux * cos * cos' / (pi d^2), bounded near by as in kernels/lights/disc.clh.
typedef struct {
    float4 position;  // xyz; w: squared radius of the disc
    float4 normal;    // xyz unit; w: its square again
    float4 flux;      // rgb reflected flux, lumen, exposed; w: 1 when the light is on a surface
} IndirectLight;

typedef struct {
    uint emitter;          // index of the spotlight
    uint candidate_count;  // Halton indices 1 .. candidate_count are tried; a multiple of 32
    uint light_count;      // of all emitters together: how long the list of accepted ones is
    uint pad_;
} AcceptParams;

typedef struct {
    uint light_count;  // of all emitters together
    uint emitter_count;
    float scale;      // multiplies every flux; 1
    float footprint;  // multiplies the disc area that bounds each light; 1
} FetchParams;

typedef struct {
    uint light_count;     // positive indirect lights
    uint negative_count;  // samples of the camera image
    uint stride;          // of the G-buffer planes
    float back_facing;    // least cosine * distance that counts as behind; float spacing
    float footprint;      // multiplies the disc area that bounds each light; 1
    float shift_x;        // of the low-discrepancy points across the image, [0,1)
    float shift_y;
    uint pad_;
} NegativeParams;

CLGI_SHARED_END

#endif
