// The form of raster_large for groups: a tile belongs to a group, a column of it to a lane. Lanes
// look for runs that meet the tile, each for another, and draw what they found together.
// [derived: as raster_large.cl]
//
// Work size    2D: one group a tile of the largest view, by views; at most 64 lanes a group
// Writes       visibility of its own tile
// SPDX-License-Identifier: MIT
#include "gbuffer/tile.clh"

#define LARGE_LANES 64

kernel void gbuffer_raster_large_group(RASTER_LARGE_ARGUMENTS) {
    local uint found[LARGE_LANES];
    local uint found_count;
    uint slot = (uint)get_global_id(1);
    uint run_count = counts[slot].runs;
    View view = views[params.first_view + slot];
    int tiles_across = ((int)view.width + RASTER_TILE - 1) / RASTER_TILE;
    int tiles_down = ((int)view.height + RASTER_TILE - 1) / RASTER_TILE;
    int item = (int)get_group_id(0);
    if (item >= tiles_across * tiles_down) run_count = 0;
    Tile tile = tile_of(&view, item, tiles_across);
    SceneBuffers scene = SCENE_BUFFERS;
    int lane = (int)get_local_id(0), lanes = (int)get_local_size(0);

    polygons += (ulong)slot * params.capacity;
    runs += (ulong)slot * params.capacity;
    for (uint first = 0; first < run_count; first += (uint)lanes) {
        if (lane == 0) found_count = 0;
        barrier(CLK_LOCAL_MEM_FENCE);
        uint r = first + (uint)lane;
        if (r < run_count && runs[r].left <= tile.right && runs[r].right >= tile.left &&
            runs[r].top <= tile.bottom && runs[r].bottom >= tile.top)
            found[atomic_inc(&found_count)] = r;
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint n = 0; n < found_count; ++n) {
            global const RasterRun* run = runs + found[n];
            uint end = run->first + run->count;
            for (uint p = run->first; p < end; ++p) {
                global const RasterPolygon* listed = polygons + p;
                if (listed->left > tile.right || listed->right < tile.left ||
                    listed->top > tile.bottom || listed->bottom < tile.top)
                    continue;
                RasterPolygon polygon = *listed;
                tile_draw(&view, params.scene_flags, &tile, &polygon, &scene, visibility, 0,
                          RASTER_FUSED, lane, lanes);
            }
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}
