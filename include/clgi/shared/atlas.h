// Texels of a light atlas, and the VPLs that light them.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_ATLAS_H
#define CLGI_SHARED_ATLAS_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// Shooting VPLs and the texels.
typedef struct {
    uint first_shooter;  // in the list of sites
    uint shooter_count;
    uint site_stride;    // of the planes of sites
    uint sample_stride;  // of the planes of sample points
    uint texel_count;
    uint stride;       // of the planes of texels, of the irradiance, and of rows of SEEN_VPLS sites
    uint first_texel;  // of this part, a multiple of the packet
    uint flags;        // FILL_...
    float lift;        // as in TransportParams, for gather_open
    uint pad0_;
    uint pad1_;
    uint pad2_;
} FillParams;

enum {
    FILL_KEPT = 1,         // what texels see is kept: a site has its own bit; else a shooter has
    FILL_FORM_FACTORS = 2  // form factors are summed as well
};

// Which texels are seen by which VPLs: rows of a byte for every texel, a bit for every VPL of eight.
enum { SEEN_VPLS = 8 };

// Looking texels up in the hemicubes of a batch.
typedef struct {
    uint shooter_count;
    uint size;  // pixels, width of the hemicubes' faces
    uint texel_count;
    uint stride;
    uint first_texel;  // as in FillParams
    uint first_row;    // that is written
    uint pad0_;
    uint pad1_;
} SeeParams;

// Four by four texels of one chart. Each of their rows lies in the list of texels without a gap. Texels
// at its corners, and between them, are looked up first and can stand for all.
typedef struct {
    uint row[4];     // the first texel of each row
    uint corner[9];  // places in the list of texels that are looked up first
    uint corners;    // how many of them
    uint flat;       // 1: one plane holds the block, so that its corners stand for it
    uint pad_;
} AtlasBlock;

enum { BLOCK_TEXELS = 16 };

// Looking up a list of texels first, then blocks of texels where that is needed.
typedef struct {
    uint shooter_count;
    uint size;           // pixels, width of the hemicubes' faces
    uint stride;         // of the planes of texels and of rows of bits
    uint first_row;      // that is written
    uint listed_count;   // texels that are looked up first
    uint listed_stride;  // of their rows of bits
    uint unblocked;      // so many of them, the first ones, are in no block
    uint block_count;
} BlockParams;

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

// The mesh M over the faces of hemicubes [Schaerfig16, section 4.1]: a square grid, each square cut
// into two triangles. Side faces have half as many lines of squares. Corners and triangles of a
// hemicube: those of the first face line by line, then those of the sides.
typedef struct {
    uint shooter_count;
    uint size;     // pixels, width of the hemicubes' faces
    uint squares;  // of M across a face, even
    int reach;     // K: pixels to each side that the shadow test looks at; 0: one pixel alone
} MeshParams;

#define MESH_CORNERS(squares) (((squares) + 1) * (3 * (squares) + 5))
#define MESH_TRIANGLES(squares) (6 * (squares) * (squares))

// The G-buffer G at a corner of M: atlas coordinates U and their W, both linear on the screen, with
// their change per unit of the image plane to the right and up.
typedef struct {
    float u;  // texels of the page / depth
    float v;
    float w;  // 1 / depth
    uint chart;  // MESH_NO_CHART: nothing is seen there that has texels
    float u_right;
    float v_right;
    float w_right;
    float pad0_;
    float u_up;
    float v_up;
    float w_up;
    float pad1_;
} MeshCorner;

#define MESH_NO_CHART 0xffffffffu

// A triangle of M as it is projected into one chart.
typedef struct {
    float4 depth;  // x: W at the first corner; y, z: its change per unit to the right and up; w: a
                   // texel with a smaller W is none of the triangle's
    float4 box;    // texels of the page: least u, least v, largest u, largest v
    uint chart;    // MESH_NO_CHART: unused
    uint pad0_;
    uint pad1_;
    uint pad2_;
} MeshCopy;

enum { MESH_COPIES = 3 };  // of a triangle at most: a chart for every corner

// Planes of the texels' places, int.
enum { PLACE_CHART = 0, PLACE_COLUMN = 1, PLACE_ROW = 2, PLACE_PLANES = 3 };

CLGI_SHARED_END

#endif
