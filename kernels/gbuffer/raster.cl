// Draws triangles into views: small ones at once, the others listed as polygons for raster_large.
//
// A cluster that lies outside a view is passed over. Batches whose polygons find no room in the
// list any more are drawn by raster_late.
// [derived: fixed-point edge functions, after Pineda, A Parallel Algorithm for Polygon Rasterization]
//
// Work size    2D: one work-item for every RASTER_BATCH * CLGI_WIDTH triangles (rounded up), by
//              views; any local size
// Writes       visibility by integer minimum (no order); runs of polygons and late batches (any
//              order; all are drawn)
// SPDX-License-Identifier: MIT
#include "gbuffer/batch.clh"
#include "gbuffer/small.clh"
#include "gbuffer/unseen.clh"

kernel void gbuffer_raster(
    const RasterParams           params,
    global const View*           restrict views,       // [first_view + views]
    global const uint4*          restrict triangles,   // [triangle_count]
    global const float4*         restrict positions,   // [vertex_count] local frame
    global const Cluster*        restrict clusters,    // [cluster_count]
    global const PartCorners*    restrict parts,       // [cluster_count][CLUSTER_PARTS]
    global PixelWord*            restrict visibility,  // [pixels of all views]
    global RasterPolygon*        restrict polygons,    // [views][capacity]
    global RasterRun*            restrict runs,        // [views][capacity]
    global uint*                 restrict late,        // [views][late_capacity] batches
    volatile global RasterCount* restrict counts)      // [views]
{
    uint item = (uint)get_global_id(0);
    uint first = item * BATCH_TRIANGLES;
    if (first >= params.triangle_count) return;
    uint slot = (uint)get_global_id(1);
    View view = views[params.first_view + slot];
    if (params.cull && cluster_unseen(&view, clusters, first / CLUSTER_TRIANGLES)) return;
    uint small[BATCH_ROOM(BATCH_RUNS)], rest[BATCH_ROOM(BATCH_RUNS)];
    Batch batch = {small, rest, 0, 0};
    batch_sort_nth(&view, &params, item, triangles, positions, parts, &batch);
    for (int n = 0; n < batch.small_count; n += CLGI_WIDTH)
        small_draw(&view, params.stage, batch.small + n, min(batch.small_count - n, CLGI_WIDTH),
                   triangles, positions, visibility, 1);
    if (batch.rest_count == 0 || params.stage == RASTER_IDENTITY) return;  // listed before

    uint place = atomic_add(&counts[slot].polygons, (uint)batch.rest_count);
    if (place + (uint)batch.rest_count > params.capacity) {
        late[slot * params.late_capacity + atomic_inc(&counts[slot].late)] = item;
        return;
    }
    RasterRun run = {INT_MAX, INT_MAX, -1, -1, place, 0, 0, 0};
    global RasterPolygon* listed = polygons + (ulong)slot * params.capacity + place;
    for (int n = 0; n < batch.rest_count; n += CLGI_WIDTH) {
        RasterPolygon made[CLGI_WIDTH];
        int count = batch_polygons(&view, batch.rest + n, min(batch.rest_count - n, CLGI_WIDTH),
                                   triangles, positions, made);
        for (int k = 0; k < count; ++k) {
            listed[run.count] = made[k];
            run.count += 1;
            run.left = min(run.left, made[k].left);
            run.right = max(run.right, made[k].right);
            run.top = min(run.top, made[k].top);
            run.bottom = max(run.bottom, made[k].bottom);
        }
    }
    if (run.count > 0)
        runs[slot * params.capacity + atomic_inc(&counts[slot].runs)] = run;
}
