// Empties views: background everywhere, no polygons listed.
// [derived: all bits set is the identity of the unsigned minimum]
//
// Work size    2D: one work-item for every 16 pixels of the largest view (rounded up), by views;
//              any local size
// Writes       the words of each view's pixels; the first work-item of a view its counts
// SPDX-License-Identifier: MIT
#include "gbuffer/visibility.clh"

kernel void gbuffer_clear(
    const RasterParams          params,
    global const View*          restrict views,       // [first_view + views]
    global PixelWord*           restrict visibility,  // [pixels of all views]
    global RasterCount*         restrict counts)      // [views]
{
    uint slot = (uint)get_global_id(1);
    uint pixels = views[params.first_view + slot].width * views[params.first_view + slot].height;
    uint begin = views[params.first_view + slot].first_pixel;
    uint first = (uint)get_global_id(0) * 16;
    if (get_global_id(0) == 0) {
        counts[slot].runs = 0;
        counts[slot].polygons = 0;
        counts[slot].late = 0;
    }
    for (uint pixel = first; pixel < min(first + 16, pixels); ++pixel)
        visibility[begin + pixel] = (PixelWord)-1;
}
