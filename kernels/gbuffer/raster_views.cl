// Draws whole views, each by one work-item: no list, no atomics, and the view stays in the cache.
// It pays where there are many small views; its bits are those of raster and raster_large.
// [derived: as raster.cl and raster_large.cl]
//
// Near clusters come first, and now and then the kernel notes the farthest word of every square of
// pixels: clusters and polygons behind these are passed over.
//
// Work size    1D, one work-item a view; any local size
// Writes       the words of its own view's pixels
// SPDX-License-Identifier: MIT

// Runs of triangles that are drawn between two looks at all pixels: one for so many pixels, within
// limits. A look then costs less than they do.
#define PIXELS_A_RUN (64 / PART_RUNS)
#define LEAST_RUNS_A_LOOK (32 * PART_RUNS)
#define MOST_RUNS_A_LOOK (224 * PART_RUNS)
#define VIEW_RUNS (MOST_RUNS_A_LOOK + CLUSTER_RUNS)

#include "gbuffer/batch.clh"
#include "gbuffer/near_first.clh"
#include "gbuffer/occlusion.clh"
#include "gbuffer/small.clh"
#include "gbuffer/tile.clh"

static void draw_runs(const View* view, const RasterParams* params, uint* runs, int count,
                      const Occlusion* occlusion, global const PartCorners* parts,
                      const SceneBuffers* scene, global PixelWord* visibility) {
    uint small[BATCH_ROOM(VIEW_RUNS)], rest[BATCH_ROOM(VIEW_RUNS)];
    Batch batch = {small, rest, 0, 0};
    batch_sort(view, params, runs, count, scene->triangles, scene->positions, parts, &batch);
    for (int n = 0; n < batch.small_count; n += CLGI_WIDTH)
        small_draw(view, RASTER_FUSED, batch.small + n, min(batch.small_count - n, CLGI_WIDTH),
                   scene->triangles, scene->positions, visibility, 0);
    for (int n = 0; n < batch.rest_count; n += CLGI_WIDTH) {
        RasterPolygon made[CLGI_WIDTH];
        int polygons = batch_polygons(view, batch.rest + n, min(batch.rest_count - n, CLGI_WIDTH),
                                      scene->triangles, scene->positions, made);
        for (int k = 0; k < polygons; ++k) {
            uint key = ~(as_uint(made[k].closest) | 1u);
            if (!occlusion_hides(occlusion, made[k].left, made[k].top, made[k].right,
                                 made[k].bottom, key))
                tile_draw_all(view, params->scene_flags, made + k, scene, visibility, 0,
                              RASTER_FUSED, 0, 1);
        }
    }
}

kernel void gbuffer_raster_views(RASTER_VIEWS_ARGUMENTS) {
    uint item = (uint)get_global_id(0);
    if (item >= view_count) return;
    View view = views[params.first_view + item];
    SceneBuffers scene = SCENE_BUFFERS;
    uint pixels = view.width * view.height;
    for (uint pixel = 0; pixel < pixels; ++pixel)
        visibility[view.first_pixel + pixel] = (PixelWord)-1;

    Occlusion occlusion;
    occlusion_begin(&view, &occlusion);
    uint runs[VIEW_RUNS + PACKET_RUNS];
    int count = 0;
    int enough = clamp((int)(pixels / PIXELS_A_RUN), LEAST_RUNS_A_LOOK, MOST_RUNS_A_LOOK);
    uint cluster_count = (params.triangle_count + CLUSTER_TRIANGLES - 1) / CLUSTER_TRIANGLES;
    uint run_count = (params.triangle_count + RUN_TRIANGLES - 1) / RUN_TRIANGLES;
    NearFirst list;
    near_first_begin(&list);
    while (cluster_count > 0 &&
           near_first_list(&view, params.cull, clusters, nodes, cluster_count, &list)) {
        for (int n = 0; n < list.count; ++n) {
            uint cluster = list.cluster[list.order[n]];
            uint wanted = ALL_PARTS;
            if (params.cull) {
                if (occlusion_hides_cluster(&occlusion, &view, clusters + cluster)) continue;
                wanted = occlusion_parts(&occlusion, &view, clusters + cluster);
            }
            uint first = cluster * CLUSTER_RUNS;
            for (uint k = 0; k < min(run_count - first, (uint)CLUSTER_RUNS); ++k) {
                runs[count] = first + k;
                count += wanted >> k / PART_RUNS & 1;
            }
            if (count < enough) continue;
            draw_runs(&view, &params, runs, count, &occlusion, parts, &scene, visibility);
            occlusion_update(&view, visibility, &occlusion);
            count = 0;
        }
    }
    if (count > 0) draw_runs(&view, &params, runs, count, &occlusion, parts, &scene, visibility);
}
