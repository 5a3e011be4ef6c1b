// An irradiance cache: records on surfaces, what their hemicubes see, and how light between them is
// looked up.                                                        [Ward88; derived: hemicubes]
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_CACHE_H
#define CLGI_SHARED_CACHE_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// Planes of the records. The first nine are those of a G-buffer, so hemicubes can stand on them and
// lights light them.
enum { RECORD_POSITION = 0, RECORD_NORMAL = 3, RECORD_GEOMETRIC = 6, RECORD_PLANES = 9 };

// Planes of places that may become records: those of a record, what the surface reflects of white
// light, in luminance and in colour.
enum { PICK_REFLECTANCE = RECORD_PLANES, PICK_ALBEDO, PICK_PLANES = PICK_ALBEDO + 3 };

// A tree over space that names the records near each place: eight children a node, and in leaves a
// list for each of the six ways that a surface can face, +x, -x, +y and so on.
// Where the mean over many places counts, as in hemicubes, the first few are looked at.
enum { CACHE_LISTED = 16, CACHE_FEW = 5, CACHE_WAYS = 6 };
#define CACHE_LEAF 0x80000000u  // of a node: the rest is the leaf's number, else the first child's place
#define CACHE_NONE 0xffffffffu

typedef struct {
    float4 centre;  // xyz of the root's cube, local frame; w: half its side
    uint node_count;
    uint record_count;
    uint stride;  // of the planes of records and of their light
    uint pad_;
} CacheTree;

// What lists are made from: records in the order of the leaves that they lie in, in crowds with a box
// around each.
enum { CACHE_CROWD = 16 };

typedef struct {
    float4 cube;  // middle, local frame; w: half its side
    uint before;  // records that lie in the leaves before it
    uint pad0_;
    uint pad1_;
    uint pad2_;
} CacheLeaf;

typedef struct {
    uint leaf_count;
    uint record_count;
    uint stride;        // of the planes of records, a multiple of CACHE_CROWD
    uint crowd_stride;  // of the planes of boxes, a multiple of 16
} CacheListParams;

// Emissive surfaces that hemicubes light by: those beyond the focus, which have no points with
// shadow maps (EmitterOptions::focused), or all.
enum { CACHE_EMISSION_BEYOND = 0, CACHE_EMISSION_ALL = 1 };

// Records of a batch and their hemicubes.
typedef struct {
    uint first;   // record
    uint count;
    uint stride;  // of the planes of records
    uint size;    // pixels, side of a hemicube's whole face, a multiple of 8 and of 8 every
    float4 sky;   // rgb times the sky's texel: exposed radiance
    uint sky_width;  // texels; 0: no sky
    uint sky_height;
    float sky_turn;  // in turns, as in EnvironmentParams
    uint emission;   // which emissive surfaces count, a CACHE_EMISSION
    uint picks;     // surfaces of each record that pick takes
    uint first_sample;  // of the sequence of directions that pick takes
    uint pick_stride;
    uint emitter_count;  // with shadow maps of depth alone
    float focus;         // square of its radius, local units
    uint whole_emitters;  // so many light every pixel of a hemicube
    uint emitter_step;    // of the others each lights one block of 16 pixels in so many, at least 1
    uint thin;  // of the blocks of 16 pixels one in so many counts, at least 1
    uint spots;  // 1: some tiles of lights, if any, do not light pixels
    uint lobes;  // 1: direct light is reflected by lobes, not as by diffuse surfaces
    uint skipped;  // emitters after the whole ones, which light no hemicube
    uint bright;   // 1: behind the sky's texels are those of its bright part, which shown light lacks
    uint every;    // surfaces are looked at in one of so many columns and rows, at least 1
    uint row_stride;  // of a row of the transport: whole packets, for all records of the tree
    uint pad0_;
    uint pad1_;
} CacheParams;

// What a light lights in small places, such as the sun's spot behind a hole, falls between the pixels
// of hemicubes. It lights records by VPLs instead. Views of lights are divided into tiles, so many a
// side, in each of which one or the other holds.
enum { SPOT_TILES = 32, SPOT_TILES_A_VIEW = 1024 };

// A view of a light, or a part of one, drawn to find such places.
typedef struct {
    uint emitter;
    uint light_view;  // among the views of all emitters
    uint pad0_;
    uint pad1_;
} SpotView;

typedef struct {
    uint view_count;    // views of lights that are drawn; of one size, a multiple of SPOT_TILES
    uint sample_count;  // VPLs
    uint pad0_;
    uint pad1_;
} SpotParams;

// Where a VPL lies: the texel of this rank among those of a tile that count.
typedef struct {
    uint view;  // SpotView
    uint tile;
    uint rank;
    float texels;  // that it stands for
} SpotSample;

typedef struct {
    uint record_count;
    uint stride;      // of planes
    uint first;       // record
    uint row_stride;  // as CacheParams has it, at most stride
} CacheBounceParams;

// A picture whose light of the sky is corrected, in blocks of so many pixels a side.
enum { CACHE_BLOCK = 8 };

// Of so many pixels across or down.
CLGI_INLINE uint cache_blocks(uint pixels) { return (pixels + CACHE_BLOCK - 1) / CACHE_BLOCK; }

typedef struct {
    uint width;  // pixels
    uint height;
    uint stride;    // of the planes of pixels
    float scale;    // from what was found to the sum over the correction's directions, above 0
    float total;    // directions of all corrections so far, with this one, above 0
    float squares;  // sum of the squares of how many each has; with `again`: of those together
    uint again;     // 1: one more of the directions that the last one had
    uint pad_;
    float4 low;  // xyz: what the directions' shadow maps cover, local frame
    float4 high;
} CacheCorrectParams;

typedef struct {
    uint count;     // records
    uint stride;    // of their planes
    float scale;    // these as CacheCorrectParams has them, but of each set of directions once
    float total;
    float squares;
    uint pad0_;
    uint pad1_;
    uint pad2_;
} CacheSettleParams;

typedef struct {
    uint point_count;
    uint stride;  // of the G-buffer, the irradiance and the doubt
    uint more;    // 1: a second light is shown by the same shares
    uint pad_;
} CacheShowParams;

// How the light that is sharpened will be looked up.
typedef struct {
    uint most;     // records of a list that are looked at, at most CACHE_LISTED
    uint carried;  // 1: their shares are carried on, as for pixels
    uint more;     // 1: a second light is sharpened as the first is
    uint pad_;
} CacheSharpenParams;

// Radiance in the pixels of hemicubes, and its means over 2 x 2 and 4 x 4 of them. Records that were
// met have none; the others have a slot each, in their order.
enum { AROUND_LEVELS = 3 };

typedef struct {
    uint seen;   // records that come first
    uint met;    // that follow them
    uint slots;  // of all other records
    uint size;   // pixels in which surfaces are looked at, side of a whole face, a multiple of 8
} CacheAround;

// The first pixel of a level; of AROUND_LEVELS: how many there are.
CLGI_INLINE uint around_first(uint slots, uint size, uint level) {
    uint sum = 0, of_level = 3 * slots * size * size;
    for (uint k = 0; k < level; ++k, of_level /= 4) sum += of_level;
    return sum;
}

typedef struct {
    float4 eye;  // xyz: local frame; w: 1: the direction to the eye, everywhere
    uint pixel_count;
    uint stride;           // of the planes of pixels
    uint first_direction;  // of a sequence
    uint directions;       // a pixel, at least 1
    float exposure;
    float smooth;  // lobes of alpha up to it are followed by rays (reflect.cl)
    uint sky_width;  // texels, of the sky that such rays see; 0: none
    uint sky_height;
    uint shared;  // directions that a lobe's solid angle is shared by, with those of other samples
    uint pad0_;
    uint pad1_;
    uint pad2_;
} CacheGlossParams;

CLGI_SHARED_END

#endif
