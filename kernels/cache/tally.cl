// How much of what each tile of a light's view lights is seen by records: texels, and the area of
// their sections across the light.                 [derived: light views as sets of samples]
//
// Work size    1D, one work-item a tile of every view; any local size; tail guarded
// Writes       its own number and its own area
// Cost         20 flops and 8 bytes a texel, 30 flops of spots; 20 more where another triangle follows
// SPDX-License-Identifier: MIT
#include "cache/spots.clh"
#include "scene/buffers.clh"

kernel void cache_tally(
    const SpotParams        params,
    global const SpotView*  restrict of,           // [view_count]
    global const View*      restrict views,        // [view_count], drawn
    global const ulong*     restrict visibility,
    global const View*      restrict light_views,
    global const Emitter*   restrict emitters,
    global const uint*      restrict seen,         // two bits for each vertex
    global const uint*      restrict wanted,       // [light views][SPOT_TILES_A_VIEW]
    SCENE_ARGUMENTS,
    global uint*            restrict count,        // [view_count][SPOT_TILES_A_VIEW] texels
    global float*           restrict area)         // [view_count][SPOT_TILES_A_VIEW] local units squared
{
    uint item = (uint)get_global_id(0), tiles = SPOT_TILES_A_VIEW;
    if (item >= params.view_count * tiles) return;
    uint index = item / tiles, tile = item % tiles, light_view = of[index].light_view;
    global const Emitter* emitter = emitters + of[index].emitter;
    View view = views[index], whole = light_views[light_view];
    uint width = view.width / SPOT_TILES, height = view.height / SPOT_TILES, found = 0;
    float sum = 0.0f;
    SpotTriangle before = {-1, false};
    for (uint k = 0; k < width * height; ++k) {
        SpotTexel texel = spot_texel(emitter, &view, &whole, tile % SPOT_TILES * width + k % width,
                                     tile / SPOT_TILES * height + k / width, &before, visibility,
                                     seen, wanted + light_view * tiles, triangles, positions);
        if (texel.triangle < 0) continue;
        ++found;
        sum += texel.area;
    }
    count[item] = found;
    area[item] = sum;
}
