// Draws the polygons of batches that found no room in a view's list.
// [derived: as raster.cl and raster_large.cl, pixel by pixel the same]
//
// Work size    2D: one work-item for every RASTER_BATCH * CLGI_WIDTH triangles (rounded up), by
//              views; any local size; all but the late batches return at once
// Writes       visibility by integer minimum (no order)
// SPDX-License-Identifier: MIT
#include "gbuffer/batch.clh"
#include "gbuffer/tile.clh"

kernel void gbuffer_raster_late(
    const RasterParams         params,
    global const View*         restrict views,       // [first_view + views]
    global const uint*         restrict late,        // [views][late_capacity] batches
    global const RasterCount*  restrict counts,      // [views]
    global const PartCorners*  restrict parts,       // [cluster_count][CLUSTER_PARTS]
    SCENE_ARGUMENTS,
    global PixelWord*          restrict visibility)  // [pixels of all views]
{
    uint item = (uint)get_global_id(0);
    uint slot = (uint)get_global_id(1);
    if (item >= counts[slot].late) return;
    View view = views[params.first_view + slot];
    SceneBuffers scene = SCENE_BUFFERS;
    uint small[BATCH_ROOM(BATCH_RUNS)], rest[BATCH_ROOM(BATCH_RUNS)];
    Batch batch = {small, rest, 0, 0};
    batch_sort_nth(&view, &params, late[slot * params.late_capacity + item], triangles, positions,
                   parts, &batch);
    for (int n = 0; n < batch.rest_count; n += CLGI_WIDTH) {
        RasterPolygon made[CLGI_WIDTH];
        int count = batch_polygons(&view, batch.rest + n, min(batch.rest_count - n, CLGI_WIDTH),
                                   triangles, positions, made);
        for (int k = 0; k < count; ++k)
            tile_draw_all(&view, params.scene_flags, made + k, &scene, visibility, 1,
                          params.stage, 0, 1);
    }
}
