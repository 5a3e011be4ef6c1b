// Draws the large, clipped and alpha-masked triangles, tile by tile, a packet of pixels at a time.
//
// A tile of 32x32 pixels belongs to one work-item, so nothing here is atomic. Edge functions are
// brought to whole pixels, floor(E / 256), which keeps their sign at pixel centres and fits 32
// bits wherever the sign changes inside the tile; elsewhere the edge covers the tile or misses it.
// [derived: as raster.cl, which set the polygons up]
//
// Work size    1D, one work-item a tile; any local size; tail guarded
// Writes       visibility of its own tile
// SPDX-License-Identifier: MIT
#include "gbuffer/surface.clh"
#include "gbuffer/visibility.clh"

typedef struct {
    int base[8];  // floor(E / 256) at the tile's first pixel
    int step_x[8];
    int step_y[8];
    int count;  // edges that cut the tile
} TileEdges;

// Pixels of a tile, inclusive.
typedef struct {
    int left, top, right, bottom;
} Tile;

// The edges of a polygon seen from one tile. Returns 0 when the polygon misses the tile.
static int tile_edges(global const RasterPolygon* polygon, const Tile* tile, TileEdges* edges) {
    edges->count = 0;
    int corners = (int)polygon->count;
    for (int i = 0; i < corners; ++i) {
        int next = i + 1 < corners ? i + 1 : 0;
        int px = polygon->x[i], py = polygon->y[i];
        int dx = polygon->x[next] - px, dy = polygon->y[next] - py;
        if (dx == 0 && dy == 0) continue;
        long x = (long)tile->left * SUBPIXELS + SUBPIXELS / 2 - px;
        long y = (long)tile->top * SUBPIXELS + SUBPIXELS / 2 - py;
        long owned = dy < 0 || (dy == 0 && dx > 0) ? 0 : -1;
        long first = ((long)dx * y - (long)dy * x + owned) >> 8;
        long across = -(long)dy * (RASTER_TILE - 1);
        long down = (long)dx * (RASTER_TILE - 1);
        long least = first + min(across, 0L) + min(down, 0L);
        long most = first + max(across, 0L) + max(down, 0L);
        if (most < 0) return 0;
        if (least >= 0) continue;
        edges->base[edges->count] = (int)first;
        edges->step_x[edges->count] = -dy;
        edges->step_y[edges->count] = dx;
        edges->count += 1;
    }
    return 1;
}

#ifndef CLGI_NO_TEXTURES
// Lanes of a masked triangle that its texture leaves opaque.
static intp opaque(const View* view, int x, int y, intp covered, uint triangle,
                   const SceneBuffers* scene, uint flags) {
    intp lanes = packet_select((intp)(-1), (intp)((int)triangle), covered);
    floatp wx = (packet_float(x + packet_lanes) + 0.5f) * (2.0f / (float)view->width) - 1.0f;
    float wy = 1.0f - ((float)y + 0.5f) * (2.0f / (float)view->height);
    Surface surface = gbuffer_surface(view, wx * view->right.w + view->window.x,
                                      packet_splat(wy * view->up.w + view->window.y),
                                      lanes, scene, flags);
    uint material = scene->triangles[triangle].w & TRIANGLE_MATERIAL;
    return covered & (surface.alpha >= scene->materials[material].emission.w);
}
#endif

// Puts (key, triangle) into the covered pixels where it wins. Words are 64 bits wide, so half a
// packet fills a vector.
static void put_packet(uintp key, uint triangle, intp covered, global ulong* pixels) {
#if CLGI_WIDTH == 1
    ulong word = ((ulong)key << 32) | triangle;
    if (covered) *pixels = min(*pixels, word);
#else
#define HALF_ PACKET_JOIN(PACKET_HALF_OF_, CLGI_WIDTH)
#define PACKET_HALF_OF_4 2
#define PACKET_HALF_OF_8 4
#define PACKET_HALF_OF_16 8
    typedef PACKET_JOIN(ulong, HALF_) ulong_half;
    typedef PACKET_JOIN(long, HALF_) long_half;
    ulong_half old = PACKET_JOIN(vload, HALF_)(0, pixels);
    ulong_half word = (PACKET_JOIN(convert_ulong, HALF_)(key.lo) << 32) | triangle;
    long_half wins = PACKET_JOIN(convert_long, HALF_)(covered.lo) & (word < old);
    PACKET_JOIN(vstore, HALF_)(select(old, word, wins), 0, pixels);
    old = PACKET_JOIN(vload, HALF_)(1, pixels);
    word = (PACKET_JOIN(convert_ulong, HALF_)(key.hi) << 32) | triangle;
    wins = PACKET_JOIN(convert_long, HALF_)(covered.hi) & (word < old);
    PACKET_JOIN(vstore, HALF_)(select(old, word, wins), 1, pixels);
#endif
}

// Draws a polygon's pixels of one tile.
static void draw_polygon(const View* view, uint scene_flags, const Tile* tile,
                         global const RasterPolygon* polygon, const SceneBuffers* scene,
                         global ulong* visibility) {
    TileEdges edges;
    if (!tile_edges(polygon, tile, &edges)) return;
    int first_x = max(polygon->left, tile->left);
    first_x = tile->left + (first_x - tile->left) / CLGI_WIDTH * CLGI_WIDTH;
    int last_x = min(polygon->right, tile->right);
    int last_y = min(polygon->bottom, tile->bottom);
    for (int y = max(polygon->top, tile->top); y <= last_y; ++y) {
        float row_closeness =
            polygon->closeness + ((float)y + 0.5f - polygon->origin_y) * polygon->slope_y;
        for (int x = first_x; x <= last_x; x += CLGI_WIDTH) {
            intp column = x + packet_lanes;
            intp covered = (column >= polygon->left) & (column <= last_x);
            for (int e = 0; e < edges.count; ++e)
                covered &= (edges.base[e] + edges.step_y[e] * (y - tile->top) +
                            edges.step_x[e] * (column - tile->left)) >= 0;
            if (!packet_any(covered)) continue;
#ifndef CLGI_NO_TEXTURES
            if (polygon->material & TRIANGLE_MASKED) {
                covered = opaque(view, x, y, covered, polygon->triangle, scene, scene_flags);
                if (!packet_any(covered)) continue;
            }
#endif
            floatp closeness = row_closeness + (packet_float(column) + 0.5f - polygon->origin_x) *
                                                   polygon->slope_x;
            closeness = packet_min(packet_max(closeness, packet_splat(polygon->farthest)),
                                   packet_splat(polygon->closest));
            uintp key = ~packet_bits(closeness);

            global ulong* pixels = visibility + view->first_pixel + (uint)y * view->width + (uint)x;
            if (x + CLGI_WIDTH - 1 <= tile->right) {
                put_packet(key, polygon->triangle, covered, pixels);
            } else {  // the last packet of a row that is no multiple of the width
                int lane_covered[CLGI_WIDTH];
                uint lane_key[CLGI_WIDTH];
                packet_store(covered, lane_covered);
                packet_store(key, lane_key);
                for (int k = 0; x + k <= tile->right; ++k)
                    if (lane_covered[k])
                        pixels[k] =
                            min(pixels[k], ((ulong)lane_key[k] << 32) | polygon->triangle);
            }
        }
    }
}

kernel void gbuffer_raster_large(
    const View                    view,
    const uint                    scene_flags,
    global const RasterPolygon*   restrict polygons,   // [triangle_count]
    global const RasterRun*       restrict runs,       // [*run_count]
    global const uint*            restrict run_count,  // [1]
    SCENE_ARGUMENTS,
    global ulong*                 restrict visibility)  // [pixels of all views]
{
    int tiles_across = ((int)view.width + RASTER_TILE - 1) / RASTER_TILE;
    int tiles_down = ((int)view.height + RASTER_TILE - 1) / RASTER_TILE;
    int item = (int)get_global_id(0);
    if (item >= tiles_across * tiles_down) return;
    Tile tile;
    tile.left = item % tiles_across * RASTER_TILE;
    tile.top = item / tiles_across * RASTER_TILE;
    tile.right = min(tile.left + RASTER_TILE, (int)view.width) - 1;
    tile.bottom = min(tile.top + RASTER_TILE, (int)view.height) - 1;
    SceneBuffers scene = SCENE_BUFFERS;

    uint count = run_count[0];
    for (uint r = 0; r < count; ++r) {
        global const RasterRun* run = runs + r;
        if (run->left > tile.right || run->right < tile.left || run->top > tile.bottom ||
            run->bottom < tile.top)
            continue;
        uint end = run->first + run->count;
        for (uint p = run->first; p < end; ++p) {
            global const RasterPolygon* polygon = polygons + p;
            if (polygon->left > tile.right || polygon->right < tile.left ||
                polygon->top > tile.bottom || polygon->bottom < tile.top)
                continue;
            draw_polygon(&view, scene_flags, &tile, polygon, &scene, visibility);
        }
    }
}
