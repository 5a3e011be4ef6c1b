// Emitters, which are sampled, and the VPLs that result.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_LIGHTS_H
#define CLGI_SHARED_LIGHTS_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

enum { EMITTER_SPOT = 0, EMITTER_POINT = 1, EMITTER_DIRECTIONAL = 2, EMITTER_AREA = 3 };

// Added to the kind of a spot too narrow for rejection: its cone is mapped directly.
enum { EMITTER_KIND = 3, EMITTER_MAPPED = 4 };

// What sends direct light: a point, spot or directional light, a sample point of an emissive
// surface, or a direction of the environment.
typedef struct {
    float4 position;   // xyz; directional: centre of the lit disc
    float4 axis;       // xyz unit: spot axis, light direction, surface normal; w: cos(outer angle)
    float4 right;      // xyz unit, completes a frame with axis; w: cos(inner angle)
    float4 intensity;  // rgb: candela; directional lux; area: flux, lumen. All exposed
    float4 shift;      // of the low-discrepancy points: bases 2, 3, 5, 7; each in [0,1)
    float range;       // where the light ends; 0: unlimited
    float measure;     // divided among the samples: steradians; directional: area of the disc;
                       // area: this emitter's part of the projected steradians of all area lights
    float area;        // area lights: of the emitting surface that this sample represents;
                       // directional: of the disc, for one VPL of all that share it
    uint kind;         // EMITTER_..., EMITTER_MAPPED
    uint first_view;   // its views of the scene: 1 (spot, directional), 5 (area) or 6 (point); 2
                       // (directional, with a focus): around the focus, and of all
    uint view_count;   // 0: nothing lies between it and any surface
    uint first_vpl;  // its share of the VPLs
    uint vpl_count;
    uint first_index;  // of its points in their sequence, at least 1. All directions of an
                       // environment continue one sequence, and so do all area samples
    float taken_over;  // multiplies the flux of its VPLs, because emitters too weak for a VPL leave
                       // their flux to the others; 1 if all have one
    uint pad0_;
    uint pad1_;
} Emitter;

// A VPL: a point light with a cosine lobe that represents a disc around it. Its irradiance is
// flux * cos * cos' / (pi d^2), bounded at short distances as in kernels/lights/disc.clh.
typedef struct {
    float4 position;  // xyz; w: squared radius of the disc
    float4 normal;    // xyz unit; w: its square again
    float4 flux;      // rgb reflected flux, lumen, exposed; w: 1 when the VPL is on a surface
} Vpl;

typedef struct {
    uint emitter;          // index of the spot
    uint candidate_count;  // Halton indices 1 .. candidate_count are tried; a multiple of 32
    uint vpl_count;        // of all emitters together: length of the list of accepted ones
    uint pad_;
} AcceptParams;

typedef struct {
    uint vpl_count;  // of all emitters together
    uint emitter_count;
    float scale;      // multiplies every flux; 1
    float footprint;  // multiplies the disc area that bounds each VPL; 1
} FetchParams;

typedef struct {
    uint vpl_count;     // VPLs
    uint negative_count;  // samples of the camera image
    uint stride;          // of the G-buffer planes
    float back_facing;    // smallest cosine * distance that counts as behind; float spacing
    float footprint;      // multiplies the disc area that bounds each VPL; 1
    float shift_x;        // of the low-discrepancy points across the image, [0,1)
    float shift_y;
    uint pad_;
} NegativeParams;

typedef struct {
    uint stride;  // of the planes and the irradiance
    uint point_count;
    uint emitter_count;
    float texel_bias;  // shadow bias, in texels of the shadow map; 1
    uint depth_words;  // words of a shadow map's pixel: 1 for depth alone, 2 for visibility
    uint add;          // 0: in the place of what is there; DIRECT_ADD, DIRECT_TAKE
    uint first_emitter;
    uint edges;  // 1: texels of shadow maps past a receiver's edge count for nothing
} DirectParams;

enum { DIRECT_ADD = 1, DIRECT_TAKE = 2 };  // to what is there, from it

CLGI_SHARED_END

#endif
