// The form of raster_views for groups: a view belongs to a group. Its lanes look for clusters that
// may be seen, each for another; sort the triangles of those out and draw small ones, each another;
// and draw large ones together, in teams that have a polygon at a time and a column of it a lane.
// [derived: as raster.cl and raster_large.cl]
//
// Work size    1D, one group a view; at most 256 lanes a group
// Writes       the words of its own view's pixels, by integer minimum (no order)
// SPDX-License-Identifier: MIT
#include "gbuffer/batch.clh"
#include "gbuffer/small.clh"
#include "gbuffer/tile.clh"
#include "gbuffer/unseen.clh"

#define VIEW_LANES 256
#define MOST_POLYGONS 32
#define TEAM 32

// Draws listed triangles, in teams of lanes.
static void draw_large(const View* view, const RasterParams* params, uint stage,
                       const local uint* listed, uint count, local RasterPolygon* polygons,
                       const SceneBuffers* scene, global PixelWord* visibility) {
    int lane = (int)get_local_id(0), lanes = (int)get_local_size(0);
    int teammates = min(lanes, TEAM), teams = lanes / teammates;
    for (uint first = 0; first < count; first += MOST_POLYGONS) {
        uint some = min(count - first, (uint)MOST_POLYGONS);
        for (uint n = (uint)lane; n < some; n += (uint)lanes) {
            uint index[CLGI_WIDTH];
            for (int k = 0; k < CLGI_WIDTH; ++k) index[k] = listed[first + n];
            RasterPolygon made[CLGI_WIDTH];
            made[0].count = 0;
            batch_polygons(view, index, 1, scene->triangles, scene->positions, made);
            polygons[n] = made[0];
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint n = (uint)(lane / teammates); n < some && lane < teams * teammates;
             n += (uint)teams) {
            RasterPolygon polygon = polygons[n];
            if (polygon.count == 0) continue;
            tile_draw_all(view, params->scene_flags, &polygon, scene, visibility, 1, stage,
                          lane % teammates, teammates);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}

kernel void gbuffer_raster_views_group(RASTER_VIEWS_ARGUMENTS) {
    local uint seen[VIEW_LANES], large[VIEW_LANES];
    local uint seen_count, large_count;
    local RasterPolygon polygons[MOST_POLYGONS];
    uint lane = (uint)get_local_id(0), lanes = (uint)get_local_size(0);
    View view = views[params.first_view + (uint)get_group_id(0)];
    SceneBuffers scene = SCENE_BUFFERS;
    uint pixels = view.width * view.height;
    for (uint pixel = lane; pixel < pixels; pixel += lanes)
        visibility[view.first_pixel + pixel] = (PixelWord)-1;
    barrier(CLK_GLOBAL_MEM_FENCE);

    uint cluster_count = (params.triangle_count + CLUSTER_TRIANGLES - 1) / CLUSTER_TRIANGLES;
#if defined(CLGI_ATOMIC64) || defined(CLGI_DEPTH_ONLY)
    const uint first_stage = RASTER_FUSED, last_stage = RASTER_FUSED;
#else
    const uint first_stage = RASTER_DEPTH, last_stage = RASTER_IDENTITY;
#endif
    for (uint stage = first_stage; stage <= last_stage; ++stage) {
        for (uint first = 0; first < cluster_count; first += lanes) {
            if (lane == 0) seen_count = 0;
            barrier(CLK_LOCAL_MEM_FENCE);
            uint cluster = first + lane;
            if (cluster < cluster_count && !(params.cull && cluster_unseen(&view, clusters, cluster)))
                seen[atomic_inc(&seen_count)] = cluster;
            barrier(CLK_LOCAL_MEM_FENCE);
            uint places = seen_count * CLUSTER_TRIANGLES;
            barrier(CLK_LOCAL_MEM_FENCE);
            for (uint place = 0; place < places; place += lanes) {
                if (lane == 0) large_count = 0;
                barrier(CLK_LOCAL_MEM_FENCE);
                uint at = place + lane;
                uint triangle = at < places ? seen[at / CLUSTER_TRIANGLES] * CLUSTER_TRIANGLES +
                                                  at % CLUSTER_TRIANGLES
                                            : params.triangle_count;
                if (triangle < params.triangle_count) {
                    uint index[CLGI_WIDTH];
                    for (int k = 0; k < CLGI_WIDTH; ++k) index[k] = triangle;
                    intp wanted, small;
                    // A lane of this kernel is a triangle, whatever the packets of others.
                    TriangleCorners corners = CLGI_WIDTH == 1 && params.cull
                                                  ? triangles_load(index, parts)
                                                  : triangles_gather(index, triangles, positions);
                    batch_classes(&view, &params, &corners, &wanted, &small);
                    if (packet_any(small))
                        small_draw(&view, stage, index, 1, triangles, positions, visibility, 1);
                    else if (packet_any(wanted))
                        large[atomic_inc(&large_count)] = triangle;
                }
                barrier(CLK_LOCAL_MEM_FENCE);
                uint count = large_count;
                barrier(CLK_LOCAL_MEM_FENCE);
                draw_large(&view, &params, stage, large, count, polygons, &scene, visibility);
            }
        }
        barrier(CLK_GLOBAL_MEM_FENCE);
    }
}
