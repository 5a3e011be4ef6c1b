// Texels of a light atlas, and the VPLs that light them.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_ATLAS_H
#define CLGI_SHARED_ATLAS_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// A batch of shooting VPLs, whose hemicubes are there, and the texels.
typedef struct {
    uint first_shooter;  // in the list of chosen sites
    uint shooter_count;
    uint site_stride;    // of the planes of sites
    uint sample_stride;  // of the planes of sample points
    uint texel_count;
    uint stride;  // of the planes of texels and of the irradiance
    uint first_texel;  // of this part, a multiple of the packet
    uint words;        // of a pixel of the hemicubes: 1 for depth alone, 2 for visibility
} FillParams;

// Points of surfaces at which a filled atlas is looked up.
typedef struct {
    uint point_count;
    uint stride;  // of the G-buffer's planes and of the irradiance
    uint triangle_count;
    uint texel_count;
    uint texel_stride;  // of the planes of texels
    uint size;          // texels, side of a page
    uint pages;
    uint pad_;
} ShowParams;

#define ATLAS_NONE 0xffffffffu  // no texel, no chart, no page

CLGI_SHARED_END

#endif
