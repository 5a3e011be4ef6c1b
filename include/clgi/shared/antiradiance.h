// Elements of a scene, the links between them, and the light that they exchange without visibility.
//
// A bin is a direction in which light travels, for what leaves an element and for what arrives at
// it: so a link reads a bin of its sender and adds to the same bin of its receiver. Rows have one
// float4 a bin (rgb, 0); those of exitant intensity are half4 with half storage. Bins are a multiple
// of 4.
//
// What elements in one plane send before them is their power times cosines, which links read without
// a row. Rows of exitant intensity are there for elements that let light through to others behind
// them, for clusters of different normals, for glossy leaves, for what moves or is linked to what
// moves, and for all below those.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_ANTIRADIANCE_H
#define CLGI_SHARED_ANTIRADIANCE_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

#define ELEMENT_NONE 0xffffffffu

// An element of the tree, in depth-first order: its subtree is itself and all up to `end`.
typedef struct {
    float4 normal;  // of what lies in one plane: unit normal times DirectionBins::hemisphere_scale,
                    // else 0; w: m^2. Where it moves, that of leaves alone follows
    uint parent;    // ELEMENT_NONE: the root
    uint end;
    uint row;       // among the leaves, or among the inner elements
    uint cut;       // of a patch with parts: CUT_EDGE... below
    uint sends;     // row of exitant intensity; ELEMENT_NONE: no link reads it
    int row_exponent;  // that row is divided by 2^row_exponent, and links that read it are
                       // multiplied by it: half storage loses nothing where areas are small
    uint pad1_;
    uint pad2_;
} Element;

// A patch is halved across an edge: k, between its corners k and k + 1. The halves are (apex, k,
// middle) and (apex, middle, k + 1); each may be halved again, so that the patch has four parts.
#define CUT_EDGE(cut) ((cut) & 3)
#define CUT_EDGE_OF_HALF(cut, half) (((cut) >> (2 + 2 * (half))) & 3)
#define CUT_TWICE 64

// Elements list[first] to list[first + count - 1].
typedef struct {
    uint first;
    uint count;
    uint step;  // LOCAL_...; of antiradiance.local alone
    uint pad0_;
} ElementParams;

// What a local pass updates. [Dachsbacher07, section 2.2] reflects and lets through at once in the
// symmetric iteration, one after the other in the asymmetric.
enum {
    LOCAL_RECEIVE = 1,  // light over links and from the sky; else none arrives
    LOCAL_REFLECT = 2,  // radiance; else it stays as it was
    LOCAL_GO_THROUGH = 4      // antiradiance; else it stays as it was
};

// Sample points of leaves: `samples` each, those of a leaf behind each other in the order of rows.
typedef struct {
    uint leaf_count;
    uint samples;
    uint stride;      // of the planes of points
    uint first_back;  // row of the first leaf that faces backwards: its points are turned round
} LeafPointParams;

// A patch as a part of its triangle of the scene: weights of the triangle's second and vertex patch corner
// at the patch's corners. vertex: of leaves, where they are shown.
typedef struct {
    float4 weights;  // of the first corner, then of the second
    float4 last;     // xy: of the vertex patch
    uint vertex[3];
    uint pad0_;
} PatchCorners;

// The two patches of a triangle that are as large as it is; ELEMENT_NONE: it has none on that side.
// Those of triangles with leaves at their vertices follow the elements', and are no elements.
typedef struct {
    uint front;
    uint back;
    uint pad0_;
    uint pad1_;
} TrianglePatches;

typedef struct {
    float4 eye;         // xyz: local frame; w: 1: the direction to the eye, everywhere
    uint pixel_count;
    uint pixel_stride;  // of the planes of pixels
    uint triangle_count;
    uint element_count;
} ShowElementsParams;

// A leaf whose surface has a lobe (docs/materials.md). Its rows of light are planes of red, green
// and blue, with room for whole packets of bins.
typedef struct {
    uint element;
    uint row;        // among all leaves
    uint material;   // of the scene: which albedos
    float exponent;  // of the lobe; those narrower than a bin are widened to it
} GlossyLeaf;

// Albedos of a lobe, as shares of their mean: at cosine (k / ALBEDO_STEPS)^2 between the normal and
// the light, k from 0 to ALBEDO_STEPS.
enum { ALBEDO_STEPS = 32 };

// Bins of a row of a glossy leaf, those that fill its last packet included.
#define GLOSS_STRIDE(bins) (((bins) + 15) / 16 * 16)

typedef struct {
    uint leaf_count;     // glossy leaves
    uint samples;        // points of each
    uint point_stride;   // of the planes of points
    uint emitter_count;
    float texel_bias;  // of shadow maps
    uint depth_words;
    uint pad0_;
    uint pad1_;
} GlossSourceParams;

typedef struct {
    float4 eye;         // as in ShowElementsParams
    uint pixel_count;
    uint pixel_stride;
    uint triangle_count;
    uint element_count;
    float exposure;
    uint pad0_;
    uint pad1_;
    uint pad2_;
} ShowGlossParams;

CLGI_SHARED_END

#endif
