// Empties a view: nothing seen anywhere, no large triangles waiting.
// [derived: all bits set is the identity of the unsigned minimum]
//
// Work size    1D, one work-item for every 8 pixels of the view (rounded up)
// Writes       visibility of its pixels; work-item 0 also run_count
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"

kernel void gbuffer_clear(
    const View            view,
    global ulong* restrict visibility,     // [pixels of all views]
    global uint*  restrict run_count)  // [1]
{
    uint pixels = view.width * view.height;
    uint first = (uint)get_global_id(0) * 8;
    if (get_global_id(0) == 0) run_count[0] = 0;
    for (uint pixel = first; pixel < min(first + 8, pixels); ++pixel)
        visibility[view.first_pixel + pixel] = (ulong)-1;
}
