// Puts a view that the host knows into a buffer of views.
// [derived: a kernel's argument is copied when it is enqueued, so the host's need not outlive it]
//
// Work size    1D, one work-item
// Writes       views[place]
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"

kernel void gbuffer_put_view(
    const View    view,
    const uint    place,
    global View*  restrict views)  // [> place]
{
    if (get_global_id(0) == 0) views[place] = view;
}
