// Draws whole views by a ray through every pixel's centre. It pays where views have few pixels and
// the scene has many triangles, of which most lie between the centres.
//
// What shows is the same as by raster_views but for centres on an edge, to a 256th of a pixel, and for
// the last bits of depth. Cost: docs/results/irradiance-cache.md.           [derived: as ray.clh]
//
// Work size    1D, one work-item a view; any local size
// Writes       the words of its own view's pixels
// SPDX-License-Identifier: MIT
#include "gbuffer/ray.clh"

kernel void gbuffer_trace_views(RASTER_VIEWS_ARGUMENTS) {
    uint item = (uint)get_global_id(0);
    if (item >= view_count) return;
    View view = views[params.first_view + item];
    SceneBuffers scene = SCENE_BUFFERS;
    RayScene of = {&view, params.scene_flags, params.triangle_count - 1, nodes, clusters, parts, &scene,
                   0.0f};
    global PixelWord* pixels = visibility + view.first_pixel;
    for (int y = 0; y < (int)view.height; ++y)
        for (int x = 0; x < (int)view.width; ++x)
            *pixels++ = params.triangle_count > 0 ? ray_word(&of, x, y) : (PixelWord)-1;
}
