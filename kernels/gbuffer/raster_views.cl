// Draws whole views, each by one work-item: no list, no atomics, and the view stays in the cache.
// It pays where there are many small views; its bits are those of raster and raster_large.
// [derived: as raster.cl and raster_large.cl]
//
// Work size    1D, one work-item a view; any local size
// Writes       the words of its own view's pixels
// SPDX-License-Identifier: MIT
#include "gbuffer/batch.clh"
#include "gbuffer/small.clh"
#include "gbuffer/tile.clh"

kernel void gbuffer_raster_views(
    const RasterParams     params,
    const uint             view_count,
    global const View*     restrict views,       // [first_view + view_count]
    global const Cluster*  restrict clusters,    // [cluster_count]
    SCENE_ARGUMENTS,
    global PixelWord*      restrict visibility)  // [pixels of all views]
{
    uint item = (uint)get_global_id(0);
    if (item >= view_count) return;
    View view = views[params.first_view + item];
    SceneBuffers scene = SCENE_BUFFERS;
    uint pixels = view.width * view.height;
    for (uint pixel = 0; pixel < pixels; ++pixel)
        visibility[view.first_pixel + pixel] = (PixelWord)-1;

    for (uint first = 0; first < params.triangle_count; first += BATCH_TRIANGLES) {
        if (params.cull && batch_unseen(&view, clusters + first / CLUSTER_TRIANGLES)) continue;
        uint last = min(first + BATCH_TRIANGLES, params.triangle_count);
        Batch batch;
        batch_sort(&view, &params, first, last, triangles, positions, &batch);
        for (int n = 0; n < batch.small_count; n += CLGI_WIDTH)
            small_draw(&view, RASTER_FUSED, batch.small + n,
                       min(batch.small_count - n, CLGI_WIDTH), triangles, positions, visibility,
                       0);
        for (int n = 0; n < batch.rest_count; n += CLGI_WIDTH) {
            RasterPolygon made[CLGI_WIDTH];
            int count = batch_polygons(&view, batch.rest + n,
                                       min(batch.rest_count - n, CLGI_WIDTH), triangles, positions,
                                       made);
            for (int k = 0; k < count; ++k)
                tile_draw_all(&view, params.scene_flags, made + k, &scene, visibility, 0,
                              RASTER_FUSED);
        }
    }
}
