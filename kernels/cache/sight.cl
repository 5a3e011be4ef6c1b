// How much of the sky's texels the hemicubes of records see.
//
//   S = sum over records and pixels w      w: form factor of a pixel that shows the texel (sees.clh)
//
// In fixed point, so that no sum depends on the order of its parts.
//                                          [derived: importance of the sky for what is seen]
//
// Work size    1D, one work-item a view, five a record; any local size; tail guarded
// Writes       adds to the texels, 2^30 for all that params.count records see
// SPDX-License-Identifier: MIT
#include "cache/sees.clh"
#include "gbuffer/window.clh"

kernel void cache_sight(
    const CacheParams     params,
    global const View*    restrict views,       // five of each record
    global const ulong*   restrict visibility,  // of all records
    volatile global uint* restrict sight)       // [sky_height][sky_width]
{
    uint item = (uint)get_global_id(0);
    if (item >= 5 * params.count) return;
    View view = views[5 * params.first + item];
    float unit = (float)(1u << 30) / (float)params.count;
    uint pixels = view.width * view.height;
    for (uint pixel = 0; pixel < pixels; pixel += CLGI_WIDTH) {
        intp triangle = cache_triangles(visibility + view.first_pixel + pixel);
        if (!packet_any(triangle < 0)) continue;
        floatp x, y;
        gbuffer_window(&view, pixel, &x, &y);
        int seen[CLGI_WIDTH];
        float factor[CLGI_WIDTH], across[CLGI_WIDTH], upward[CLGI_WIDTH];
        packet_store(triangle, seen);
        packet_store(cache_form_factor(item % 5, params.size, x, y), factor);
        packet_store(x, across);
        packet_store(y, upward);
        for (int k = 0; k < CLGI_WIDTH; ++k) {
            if (seen[k] >= 0) continue;
            float3 d = view.forward.xyz + across[k] * view.right.xyz + upward[k] * view.up.xyz;
            atomic_add(sight + cache_sky_texel(&params, d), (uint)(unit * factor[k]));
        }
    }
}
