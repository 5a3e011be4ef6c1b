// From VPLs to picture: gather, upsample, combine, tone map.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_IMAGE_H
#define CLGI_SHARED_IMAGE_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// Irradiance planes, rgb: light of VPLs less that of negative VPLs, I_s - I_n. The values are
// signed: they are below 0 where too much was removed, and combine clamps them to 0.
enum { IRRADIANCE_PLANES = 3 };

typedef struct {
    uint stride;          // of the point planes and the irradiance planes
    uint vpl_count;       // VPLs
    uint negative_count;  // negative VPLs
    uint pad_;
} GatherParams;

// The full and the low-resolution image (upsample, discontinuity, compact).
typedef struct {
    uint width;  // of the full image
    uint height;
    uint stride;      // of the full planes
    uint low_stride;  // of the low-resolution planes
    float threshold;  // discontinuity threshold; 0: every pixel is gathered
    float position_scale;  // 1 / distance from a tangent plane that counts as much as a right angle
    uint step;             // 2 or 4: one low-resolution point for step x step pixels
    uint pad_;
} RefineParams;

enum { COMPACT_BLOCK = 512 };  // pixels that one work-item counts and lists

typedef struct {
    uint width;
    uint height;
    uint stride;
    uint emitter_count;
    float exposure;    // multiplies the output: undoes the scene's exposure
    float texel_bias;  // shadow bias, in texels of the shadow map
    uint effects;      // COMBINE_...
    uint depth_words;  // words of a shadow map's pixel: 1 for depth alone, 2 for visibility
} CombineParams;

enum {
    COMBINE_DIRECT = 1,
    COMBINE_INDIRECT = 2,
    COMBINE_EMISSION = 4,
    COMBINE_SPECULAR = 8,    // with COMBINE_MATERIALS
    COMBINE_MATERIALS = 16,  // some material's diffuse share is not 1
    COMBINE_MAPPED_NORMALS = 32   // GBUFFER_MAPPED_NORMAL holds where it is not -1
};

// Radiance planes: rgb, stride apart.
enum { RADIANCE_PLANES = 3 };

// The environment in the background: a latitude-longitude picture.
typedef struct {
    float4 factor;           // rgb times the texel: cd/m^2
    uint environment_width;  // texels
    uint environment_height;
    uint stride;  // of the ids and the radiance planes
    float turn;   // rotation of the picture in the world, in turns, [0,1)
} EnvironmentParams;

// The mean of samples of a picture: radiance, and the luminance of the means of fewer samples: of
// 1, 4, 16, ... in the first of two planes, of 2, 8, 32, ... in the second.
enum { MEAN_BEFORE = RADIANCE_PLANES, MEAN_PLANES = MEAN_BEFORE + 2 };

// One more sample of a picture.
typedef struct {
    uint pixels;
    uint stride;  // of the radiance planes, both
    float share;  // of the sample in the mean: 1 / samples with it
    uint kept;    // plane for the luminance of the mean without it; 0: none
} AccumulateParams;

typedef struct {
    uint width;
    uint height;
    uint stride;
    float exposure;  // multiplies radiance before encoding
} TonemapParams;

CLGI_SHARED_END

#endif
