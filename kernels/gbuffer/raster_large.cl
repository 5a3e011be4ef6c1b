// Draws the listed polygons: the large, clipped and alpha-masked triangles.
//
// A tile of 32x32 pixels belongs to one work-item, so nothing here is atomic.
// [derived: as raster.cl, which listed the polygons]
//
// Work size    2D: one work-item a tile of the largest view, by views; any local size; tail guarded
// Writes       visibility of its own tile
// SPDX-License-Identifier: MIT
#include "gbuffer/tile.clh"

kernel void gbuffer_raster_large(RASTER_LARGE_ARGUMENTS) {
    uint slot = (uint)get_global_id(1);
    uint run_count = counts[slot].runs;
    if (run_count == 0) return;
    View view = views[params.first_view + slot];
    int tiles_across = ((int)view.width + RASTER_TILE - 1) / RASTER_TILE;
    int tiles_down = ((int)view.height + RASTER_TILE - 1) / RASTER_TILE;
    int item = (int)get_global_id(0);
    if (item >= tiles_across * tiles_down) return;
    Tile tile = tile_of(&view, item, tiles_across);
    SceneBuffers scene = SCENE_BUFFERS;

    polygons += (ulong)slot * params.capacity;
    runs += (ulong)slot * params.capacity;
    for (uint r = 0; r < run_count; ++r) {
        global const RasterRun* run = runs + r;
        if (run->left > tile.right || run->right < tile.left || run->top > tile.bottom ||
            run->bottom < tile.top)
            continue;
        uint end = run->first + run->count;
        for (uint p = run->first; p < end; ++p) {
            global const RasterPolygon* listed = polygons + p;
            if (listed->left > tile.right || listed->right < tile.left ||
                listed->top > tile.bottom || listed->bottom < tile.top)
                continue;
            RasterPolygon polygon = *listed;
            tile_draw(&view, params.scene_flags, &tile, &polygon, &scene, visibility, 0,
                      RASTER_FUSED, 0, 1);
        }
    }
}
