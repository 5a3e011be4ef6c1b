// The low-resolution points S_locam: every `step`-th pixel of every `step`-th row.
//
// Points are picked, not averaged: the mean of two surfaces lies on neither, and a picked point's
// illumination is exact for its own pixel.                          [Cochran07, section 3.5]
//
// Work size    1D, one work-item for every CLGI_WIDTH low-resolution points of a row, rows padded
//              to whole packets; any local size
// Writes       its own points; the last one zeros up to a whole packet
// SPDX-License-Identifier: MIT
#include "planes.clh"

kernel void gbuffer_downsample(
    const DownsampleParams  params,
    global const float*     restrict planes,  // [>= POINT_PLANES][stride]
    global float*           restrict points)  // [POINT_PLANES][low_stride]
{
    uint step = params.step;
    uint low_width = (params.width + step - 1) / step;
    uint low_height = (params.height + step - 1) / step;
    uint packets = (low_width + CLGI_WIDTH - 1) / CLGI_WIDTH;
    uint row = (uint)get_global_id(0) / packets;
    uint column = (uint)get_global_id(0) % packets * CLGI_WIDTH;
    if (row >= low_height) return;

    uint from = step * (row * params.width + column);
    uint to = row * low_width + column;
    uint count = min((uint)CLGI_WIDTH, low_width - column);
    for (int plane = 0; plane < POINT_PLANES; ++plane) {
        Row source = gbuffer_row(planes, plane, params.stride);
        Row target = gbuffer_row(points, plane, params.low_stride);
        uint k = 0;
        for (; k < count; ++k) row_copy_one(source, from + step * k, target, to + k);
        // Behind the last point, zeros up to a whole packet: gather reads it.
        if (row + 1 == low_height && column + CLGI_WIDTH >= low_width)
            for (; (to + k) % CLGI_WIDTH != 0; ++k) row_clear_one(target, to + k);
    }
}
