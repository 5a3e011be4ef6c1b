// The scene on the device. Geometry is in the local frame: the world moved by a double-precision
// origin and scaled by a power of two, so that every scene is of size 1 (DeviceScene::frame).
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_SCENE_H
#define CLGI_SHARED_SCENE_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// The fourth word of a triangle: material index and what the rasteriser must know of it.
enum {
    TRIANGLE_MATERIAL = 0x3fffffff,
    TRIANGLE_MASKED = 0x40000000,        // alpha decides about each pixel
    TRIANGLE_DOUBLE_SIDED = (int)0x80000000
};

// In place of a cutoff: a blended material, which covers a share alpha of the pixels.
#define ALPHA_BLENDED (-1.0f)

// One material, reduced to what light transport reads (docs/materials.md).
typedef struct {
    float4 base_color;   // linear rgb, alpha; all in [0,1]
    float4 emission;     // rgb radiance, exposed; w: alpha cutoff, or ALPHA_BLENDED
    float4 reflectance;  // x: diffuse share of base, y: coat, z: lobe share of base, w: exponent
    int base_texture;    // index or -1
    int base_uv_set;
    int emission_texture;
    int emission_uv_set;
    float4 base_u;  // u' = dot(base_u.xyz, (u, v, 1))
    float4 base_v;
    float4 emission_u;
    float4 emission_v;
    int normal_texture;
    int normal_uv_set;
    int metallic_roughness_texture;  // of metalness and roughness
    int metallic_roughness_uv_set;
    float4 normal_u;  // w: scale of the normal's x and y
    float4 normal_v;
    float4 metallic_roughness_u;  // w: metalness, times the texture's blue
    float4 metallic_roughness_v;  // w: roughness, times the texture's green
    float4 surface;  // x: metalness, y: alpha of GGX, z, w: F of no metal at 0 and 90 degrees
} MaterialRecord;     //--- 224 B

enum { MATERIAL_ROWS = 14 };  // float4 rows of a MaterialRecord
enum {
    MATERIAL_BASE = 0,
    MATERIAL_EMISSION = 1,
    MATERIAL_REFLECTANCE = 2,
    MATERIAL_BASE_UV = 4,  // two rows each
    MATERIAL_EMISSION_UV = 6,
    MATERIAL_NORMAL_UV = 9,
    MATERIAL_METALLIC_ROUGHNESS_UV = 11
};

// One texture in the texel pool: RGBA8, mip levels one after the other, each half the size.
typedef struct {
    uint first_texel;  // of level 0
    int width;
    int height;
    uint flags;
} TextureRecord;

enum {
    TEXTURE_WRAP_S = 0x3,   // 0 repeat, 1 mirrored, 2 clamp
    TEXTURE_WRAP_T = 0xc,   // the same, shifted by 2
    TEXTURE_NEAREST = 0x10,
    TEXTURE_LINEAR = 0x20,  // rgb are linear, not sRGB
    TEXTURE_LEVELS_SHIFT = 8
};

enum {
    SCENE_HAS_UVS = 1,
    SCENE_HAS_COLORS = 2,
    SCENE_HAS_TEXTURES = 4,
    SCENE_HAS_EMISSION = 8,
    SCENE_HAS_SHARES = 16,  // some material's diffuse share is not 1
    SCENE_HAS_DETAIL = 32   // textures of normals, or of metalness and roughness
};

// Consecutive triangles of the device's order, which follows space: the box around them, and which
// way they face.
enum { CLUSTER_TRIANGLES = 64 };  // the last cluster may have fewer
enum { CLUSTER_PARTS = 8, PART_TRIANGLES = CLUSTER_TRIANGLES / CLUSTER_PARTS };

typedef struct {
    float4 low;   // xyz, local frame; w: 0
    float4 high;  // xyz, local frame; w: 0
    float4 cone;  // xyz: unit axis of a cone that holds the triangles' normals; w: sine of its half
                  // angle, or 2 where they do not all face one way or are seen from both sides
    // Spheres around its eighths, in the order of triangles: x, y and z of centres, and radii.
    // Without triangles: 0.
    float part[4][CLUSTER_PARTS];
    // Boxes around the same eighths. Without triangles: 0.
    float part_low[3][CLUSTER_PARTS];
    float part_high[3][CLUSTER_PARTS];
} Cluster;

// A tree of boxes over the clusters. A node has up to sixteen of them side by side, each around a
// cluster or around all boxes of another node, which comes after it. The root is the first node.
enum { NODE_BOXES = 16 };
#define NODE_CLUSTER 0x80000000u  // of a child that is a cluster
#define NODE_NONE 0xffffffffu
enum { NODE_LEVELS = 19 };  // from the root to a cluster at most
enum { NODE_STACK = 288 };  // children that a walk from the root has put off at most

typedef struct {
    float low[3][NODE_BOXES];  // x, y and z, local frame; above `high` where there is none
    float high[3][NODE_BOXES];
    uint child[NODE_BOXES];  // NODE_CLUSTER and a cluster, or a node, or NODE_NONE
} BoxNode;

// The corners of a part's triangles side by side, so that a packet of them is read in one piece.
// What lies beyond the scene's last triangle repeats it.
typedef struct {
    float corner[3][3][PART_TRIANGLES];  // x, y and z of each corner, local frame
    uint word[PART_TRIANGLES];           // the fourth word of each triangle
} PartCorners;

typedef struct {
    uint vertex_count;
    uint triangle_count;
    uint flags;          // SCENE_HAS_...
    uint cluster_count;  // triangle_count / CLUSTER_TRIANGLES, rounded up
} SceneInfo;

// Vertices that take a new place. Doubles are two words each, the lower one first.
typedef struct {
    uint first;         // of the vertices given, as the scene's file counts them
    uint count;
    uint vertex_count;  // on the device
    uint flags;         // MOVE_...
    int exponent;       // local units per metre: 2^exponent
    uint pad0_;
    uint pad1_;
    uint pad2_;
    uint given_from[8];   // x, y, z: the world point that given positions are relative to; -0 adds
                          // nothing, to a -0 either
    uint frame_origin[8];  // x, y, z of the local frame's origin
    float4 low;            // xyz of the local frame's box, less what rounds; w is not read
    float4 high;           // and more
} MoveParams;

enum { MOVE_NORMALS = 1 };

// What a move counts, words of its status buffer.
enum {
    MOVE_NOT_FINITE = 0,  // vertices that stayed where they were
    MOVE_FARTHEST = 1,    // bits of the largest squared distance from the local origin, a float
    MOVE_LEFT = 2,        // 1 if one is outside the local frame's box
    MOVE_STATUS_WORDS = 3
};

// Vertices that nodes, skins and morph targets place. Numbers of everything that is read.
typedef struct {
    uint vertex_count;  // posed
    uint given_count;   // vertices of the buffers that are written
    uint range_count;
    uint influence_count;
    uint difference_count;
    uint matrix_count;
    uint weight_count;
    uint triangle_count;  // of flat ranges
} PoseParams;

// Consecutive vertices that are placed in the same way.
typedef struct {
    uint first;   // of the posed vertices
    uint count;
    uint given;   // the first one's place in the buffers that are written
    uint flags;   // POSE_...
    uint matrix;  // the first; that of what follows no joint is matrix + joints
    uint influences;        // of each vertex; 0: all follow the first matrix
    uint first_influence;   // [influences][count]
    uint targets;
    uint first_weight;      // [targets]
    uint first_difference;  // [targets][count] positions, then normals with POSE_MORPHS_NORMALS
    uint pad0_;
    uint pad1_;
} PoseRange;

enum {
    POSE_MORPHS_NORMALS = 1,
    POSE_FLAT = 2  // normals are those of the triangles, scene_flatten writes them
};

// From rest positions to metres from the origin of positions written; rows of [linear | translation].
typedef struct {
    float4 row[3];
} PoseMatrix;

CLGI_SHARED_END

#endif
