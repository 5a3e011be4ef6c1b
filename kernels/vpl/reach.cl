// The share of each shooter's hemisphere, weighted with the cosine, in which it meets the front of a
// surface: what is left flies out of the scene or ends on the backs of one-sided surfaces.
//
//   sum of delta form factors: top 1 / (pi (1 + u^2 + v^2)^2), sides v / (pi (1 + u^2 + v^2)^2)
//                                                          [Cohen85 hemicube; derived: 32 x 32]
//
// Work size    1D, one work-item a shooter; any local size; tail guarded
// Writes       its own share
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/vpl.h"
#include "packet.clh"

enum { REACH_GRID = 32 };  // rays across a face

kernel void vpl_reach(
    const TransportParams  params,
    global const uint*     restrict chosen,   // [first_shooter + shooter_count] sites
    global const View*     restrict views,    // [5 * shooter_count]
    global const uint*     restrict depth,    // [pixels of the views]
    global float*          restrict balance)  // [BALANCE_PLANES][stride]
{
    uint s = (uint)get_global_id(0);
    if (s >= params.shooter_count) return;
    float met = 0.0f, all = 0.0f;
    for (uint f = 0; f < 5; ++f) {
        View view = views[5 * s + f];
        uint lines = f == 0 ? REACH_GRID : REACH_GRID / 2;
        for (uint line = 0; line < lines; ++line)
            for (uint column = 0; column < REACH_GRID; ++column) {
                uint x = (2 * column + 1) * view.width / (2 * REACH_GRID);
                uint y = (2 * line + 1) * view.height / (2 * lines);
                // Of the cell's centre: that of an even number of pixels lies between two.
                float u = (float)(2 * column + 1) / (float)REACH_GRID - 1.0f;
                float v = (1.0f - (float)(2 * line + 1) / (float)lines) * view.up.w +
                          view.window.y;
                float square = 1.0f + u * u + v * v;
                float weight = (f == 0 ? 1.0f : v) / (square * square);
                all += weight;
                if ((depth[view.first_pixel + y * view.width + x] & 1u) == 0) met += weight;
            }
    }
    balance[BALANCE_REACH * params.stride + chosen[params.first_shooter + s]] = met / all;
}
