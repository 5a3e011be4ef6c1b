// Which sides of the surface hemicubes see, at its vertices.
//                                       [derived: what the picture does not reach needs no light]
//
// Work size    1D, one work-item a face of a hemicube; any local size; tail guarded
// Writes       bits of the corners of triangles that it sees, by atomics; the others stay
// Cost         5 flops a pixel, 30 where another triangle follows
// SPDX-License-Identifier: MIT
#include "cache/spots.clh"
#include "gbuffer/visibility.clh"
#include "scene/buffers.clh"

kernel void cache_mark(
    const CacheParams    params,
    global const View*   restrict views,       // five of each record
    global const ulong*  restrict visibility,  // of all records
    SCENE_ARGUMENTS,
    global uint*         restrict seen)        // [(2 vertex_count + 31) / 32] bits
{
    uint item = (uint)get_global_id(0);
    if (item >= 5 * params.count) return;
    View view = views[5 * params.first + item];
    uint pixels = view.width * view.height;
    int last = -1;
    for (uint pixel = 0; pixel < pixels; ++pixel) {
        int triangle = visibility_triangle(visibility[view.first_pixel + pixel]);
        if (triangle == last) continue;
        last = triangle;
        if (triangle < 0) continue;
        uint4 corners = triangles[triangle];
        uint side = spot_side(&view, positions, corners);
        uint vertices[3] = {corners.x, corners.y, corners.z};
        for (int k = 0; k < 3; ++k)
#ifndef CLGI_ATOMICS_ONLY  // a race checker takes the look for a race
            if (!spot_is_seen(seen, vertices[k], side))
#endif
                atomic_or(seen + (2 * vertices[k] + side) / 32,
                          1u << (2 * vertices[k] + side) % 32);
    }
}
