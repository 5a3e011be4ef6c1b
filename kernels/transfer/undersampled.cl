// Pixels in a square of four probes, one of which fails, are flagged: interpolation between vertices
// misses what arrives there. In all other squares what is shown is corrected by what its probes miss,
// bilinearly, so that no border of flagged squares is seen. Where less is shown than at the probes it
// is corrected by as much less: there may be another surface, such as a thin one before a bright wall.
//                             [Kautz04, section 4.1, per-vertex sampling; derived: see compare_probes]
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       the flag of its pixel, and what is shown there
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/receivers.h"
#include "planes.clh"

kernel void transfer_undersampled(
    const ProbeParams    params,
    global const int*    restrict ids,     // [GBUFFER_ID_PLANES][pixel_stride]
    global const float*  restrict probes,  // [4][probe_stride] what is missing at the probes, and
                                           // the sum of what is shown there
    global const uint*   restrict states,  // [columns * rows] PROBE_...
    global float*        restrict shown,   // [3][pixel_stride]
    global uchar*        restrict flags)   // [width * height] 1: undersampled
{
    uint pixel = (uint)get_global_id(0);
    if (pixel >= params.width * params.height) return;
    uint stride = params.pixel_stride, step = params.step;
    uchar flag = 0;
    if (ids[GBUFFER_TRIANGLE * stride + pixel] >= 0) {
        // The square's first column and row of probes; -1 and the last one beside the border.
        uint x = pixel % params.width + step - step / 2, y = pixel / params.width + step - step / 2;
        int left = (int)(x / step) - 1, top = (int)(y / step) - 1;
        float right = (float)(x % step) / (float)step, below = (float)(y % step) / (float)step;
        float weight = 0.0f, beside = 0.0f, missing[3] = {0.0f, 0.0f, 0.0f};
        for (int k = 0; k < 4; ++k) {
            int column = left + (k & 1), row = top + (k >> 1);
            if (column < 0 || row < 0 || column >= (int)params.columns || row >= (int)params.rows)
                continue;
            uint probe = (uint)row * params.columns + (uint)column;
            uint state = states[probe];
            if (state == PROBE_FAILS) flag = 1;
            if (state != PROBE_AGREES) continue;
            float w = (k & 1 ? right : 1.0f - right) * (k >> 1 ? below : 1.0f - below);
            weight += w;
            beside = fma(w, probes[3 * params.probe_stride + probe], beside);
            for (int c = 0; c < 3; ++c)
                missing[c] = fma(w, probes[c * params.probe_stride + probe], missing[c]);
        }
        if (!flag && weight > 0.0f) {
            float value[3], here = 0.0f;
            for (int c = 0; c < 3; ++c) {
                value[c] = row_load_one(irradiance_row(shown, c, stride), pixel);
                here += fabs(value[c]);
            }
            float share = here * weight < beside ? here / beside : 1.0f / weight;
            for (int c = 0; c < 3; ++c)
                row_store_one(fma(missing[c], share, value[c]), irradiance_row(shown, c, stride),
                              pixel);
        }
    }
    flags[pixel] = flag;
}
