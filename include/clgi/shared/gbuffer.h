// What the rasteriser takes and gives: views, the visibility buffer, the planes of a G-buffer.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_GBUFFER_H
#define CLGI_SHARED_GBUFFER_H

#include "clgi/shared/base.h"

CLGI_SHARED_BEGIN

// A window onto the scene from an eye. A point p at depth z = forward.(p - eye) is seen at
//   x = right.(p - eye) / z,  y = up.(p - eye) / z    (not divided when orthographic)
// and the image spans center +- extent. Row 0 is at the top.
typedef struct {
    float4 eye;      // xyz; w: 1 when orthographic, else 0
    float4 right;    // xyz unit; w: half extent in x, tangent of an angle (orthographic: length)
    float4 up;       // xyz unit; w: half extent in y
    float4 forward;  // xyz unit; w: near depth
    float4 window;   // x, y: center; z: far depth (orthographic only); w: share of a pixel that
                     // textures and the sky are looked up over, 0: all of it
    uint width;
    uint height;
    uint first_pixel;  // where this view's pixels begin in a visibility buffer of several views
    uint flags;        // VIEW_...
} View;

// From the bit of the shift on: blended surfaces are dithered otherwise where it differs, in views
// that are alike but for that.
enum { VIEW_CULL_BACK_FACES = 1, VIEW_DITHER_SHIFT = 8 };

// Visibility buffer: one 64-bit word per pixel, (~closeness bits) << 32 | triangle. The smallest
// wins: the nearest surface, and of equal ones the smaller triangle index. Closeness is linear on
// the screen and grows towards the eye: 1/z, or (far - z)/(far - near) when orthographic.
// Background: all bits set. A depth buffer has only the upper half of each word, 32 bits per pixel; its
// lowest bit says whether the back of a single-sided triangle is seen, 1 for the background too.

enum { VERTEX_BEFORE_NEAR = 1, VERTEX_BEYOND_GUARD = 2 };
enum { SUBPIXELS = 256, GUARD_PIXELS = 32000 };

// A triangle that is large on the screen or was clipped: a convex polygon.
typedef struct {
    int x[8];  // 24.8 fixed point, counter-clockwise on screen (y down: positive area)
    int y[8];
    float closeness;  // at pixel position (origin_x, origin_y)
    float slope_x;    // closeness per pixel
    float slope_y;
    float closest;  // largest closeness of a corner
    float farthest;
    float origin_x;  // pixels
    float origin_y;
    uint triangle;
    int left;  // pixels covered, inclusive
    int top;
    int right;
    int bottom;
    uint count;     // corners, 3 to 8
    uint material;  // fourth word of the triangle
    uint back;      // 1: of a single-sided triangle, seen from behind
    uint pad_;
} RasterPolygon;

// The polygons that one work-item of raster listed. They are neighbours on the mesh, so a tile
// outside their common box passes over all of them at once.
typedef struct {
    int left;  // pixels, inclusive
    int top;
    int right;
    int bottom;
    uint first;  // polygon
    uint count;
    uint pad0_;
    uint pad1_;
} RasterRun;

// What has been listed for one view.
typedef struct {
    uint runs;
    uint polygons;  // places asked for; more than the capacity if some did not fit
    uint late;      // batches that did not fit, for raster_late
    uint pad_;
} RasterCount;

typedef struct {
    uint triangle_count;
    uint stage;       // RASTER_...
    uint small_size;  // a triangle at most this many pixels wide and high is drawn at once
    uint first_view;  // in the buffer of views; the second dimension of the launch counts from it
    uint capacity;    // polygons, and runs, that there is room for in each view's list
    uint late_capacity;  // batches of the scene
    uint cull;           // 1: boxes, clusters and parts that no pixel shows are passed over;
                         // 0: these are not read, but by trace_views
    uint scene_flags;    // SCENE_HAS_...
} RasterParams;

// Depth alone, and any view with 64-bit atomics, is drawn in one stage; else depth comes first,
// then triangles.
enum { RASTER_FUSED = 0, RASTER_DEPTH = 1, RASTER_IDENTITY = 2 };

// Packets of triangles that one work-item of raster sorts out together; all of one cluster.
enum { RASTER_BATCH = 4 };

enum { RASTER_TILE = 32 };  // pixels; side of the squares that large polygons are drawn in

// Views around points of surfaces, made on the device: five faces of a hemicube over the surface
// in the order normal, right, up, left, down, or six of a cube: +x, -x, +y, -y, +z, -z.
typedef struct {
    uint point_count;
    uint faces;        // 5 or 6
    uint size;         // pixels, side of a whole face; even for hemicubes
    uint first_view;   // place of the first point's views
    uint first_pixel;  // place of its pixels
    uint stride;       // of the planes of points
    float lift;        // from the surface to the eye, along the normal, local frame
    float near;        // nearest depth that is drawn, local frame
    uint first_chosen;  // place of the first point in the list
    uint turned;  // 1: each hemicube about its normal by an angle of its own, against patterns
    uint pad1_;
    uint pad2_;
} CubeParams;

// Of the area of a pixel of hemicubes and cubes, and of rays like theirs: over so much of it textures
// are looked up. Such pixels are large. Means over all of one would mix the charts of an atlas, so that
// walls glow with the lamps beside their charts, and would turn the normals of a texture.
#define CUBE_FOOTPRINT 0.00390625f

// Planes of a G-buffer, each `stride` floats: three for every vector, y and z behind x.
enum {
    GBUFFER_POSITION = 0,   // local frame
    GBUFFER_NORMAL = 3,     // shading normal, unit, towards the viewer; 0 where nothing is
    GBUFFER_GEOMETRIC = 6,  // of the triangle, unit, towards the viewer
    GBUFFER_BASE = 9,       // base colour, [0,1]; combine multiplies by the material's shares
    GBUFFER_EMISSION = 12,  // radiance, exposed
    GBUFFER_DEPTH = 15,     // along the view's axis, local frame; 0 where nothing is
    GBUFFER_PLANES = 16
};

// Integer planes beside them; -1: nothing.
enum {
    GBUFFER_MATERIAL = 0,
    GBUFFER_TRIANGLE = 1,
    // Normal by a normal texture, unit, towards the viewer, by the octahedron: 16 bits each of x and
    // y, DETAIL_STEPS; -1: GBUFFER_NORMAL holds.
    GBUFFER_MAPPED_NORMAL = 2,
    // Roughness and metalness by textures, METALLIC_ROUGHNESS_BITS each; -1: the material's.
    GBUFFER_METALLIC_ROUGHNESS = 3,
    GBUFFER_ID_PLANES = 4
};
enum { DETAIL_STEPS = 65534, METALLIC_ROUGHNESS_BITS = 15, METALLIC_ROUGHNESS_STEPS = 32767 };

// Which groups of planes `resolve` writes.
enum {
    RESOLVE_GEOMETRIC = 1,
    RESOLVE_EMISSION = 2,
    RESOLVE_DEPTH = 4,
    RESOLVE_TRIANGLE = 8,
    RESOLVE_ALL = 15
};

// A point of the surface: triangle and the weights of its second and third corner.
typedef struct {
    uint triangle;  // of the device
    float b1;
    float b2;
    float footprint;  // area that it represents, local frame: selects mip levels; 0: the finest
} SurfaceSample;

typedef struct {
    uint sample_count;
    uint stride;  // of the planes and the texture coordinates
    uint write_uvs;  // 1: texture coordinates too
    uint pad_;
} SurfaceParams;

typedef struct {
    uint stride;  // floats between planes, a multiple of 16, at least width * height
    uint write;   // RESOLVE_...
    uint pad0_;
    uint pad1_;
} ResolveParams;

// Every `step`-th pixel of every `step`-th row, as the low-resolution points S_locam.
typedef struct {
    uint width;  // of the full image
    uint height;
    uint stride;      // of the full planes
    uint low_stride;  // of the low-resolution planes
    uint step;        // 2 or 4
    uint pad0_;
    uint pad1_;
    uint pad2_;
} DownsampleParams;

// From another renderer's texels to planes: local = texel * scale + offset.
typedef struct {
    float4 offset;  // xyz: where the texel (0,0,0) lies, local frame
    float scale;    // local units in a metre
    float light;    // exposed radiance of 1 cd/m^2
    uint stride;    // floats between planes, a multiple of 16, at least width * height
    uint flags;     // IMPORT_...
    uint material_count;   // ids that name no material become -1
    uint triangle_count;    // nor any triangle
    uint normal_format;     // TEXEL_..., of buffers; images know theirs
    uint geometric_format;
    uint albedo_format;  // of the base colour
    uint emission_format;
    uint pad0_;
    uint pad1_;
} ImportParams;

// What is given besides normals and base colour, and where the first row of texels belongs.
enum {
    IMPORT_POSITION = 1,    // else positions follow from depth
    IMPORT_GEOMETRIC = 2,   // else the shading normals stand in
    IMPORT_EMISSION = 4,    // else none
    IMPORT_DEPTH = 8,       // else it follows from positions
    IMPORT_MATERIAL = 16,   // else unknown: -1
    IMPORT_TRIANGLE = 32,   // else unknown: -1; only beside IMPORT_MATERIAL
    IMPORT_TOP_FIRST = 64   // row 0 is the top one; else the bottom one, as OpenGL has it
};

// Layouts of a texel in a buffer.
enum { TEXEL_RGBA32F = 0, TEXEL_RGBA16F = 1, TEXEL_RGBA8 = 2 };

// A set of points to be lit: position and shading normal, six planes in G-buffer order.
enum { POINT_PLANES = 6 };

CLGI_SHARED_END

#endif
