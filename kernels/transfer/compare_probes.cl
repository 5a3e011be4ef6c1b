// How far the light at probes is from what is shown at their pixels.
//
// The difference replaces the light. A probe fails where the sum of its channels' differences is more
// than the threshold of the larger of the two sums, or not finite.
//                  [Kautz04, section 4.1, per-vertex sampling; derived: undersampling is measured]
//
// Work size    1D, one work-item a probe; any local size; tail guarded
// Writes       difference, what is shown, and state of its probe
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/receivers.h"
#include "finite.clh"
#include "planes.clh"
#include "transfer/probe.clh"

kernel void transfer_compare_probes(
    const ProbeParams    params,
    global const int*    restrict ids,     // [GBUFFER_ID_PLANES][pixel_stride]
    global const float*  restrict shown,   // [3][pixel_stride] interpolated
    global float*        restrict probes,  // [4][probe_stride] what arrives -> what is missing, and
                                           // the sum of what is shown
    global uint*         restrict states)  // [columns * rows] PROBE_...
{
    uint probe = (uint)get_global_id(0);
    if (probe >= params.columns * params.rows) return;
    uint stride = params.pixel_stride, pixel = probe_pixel(params, probe);
    float apart = 0.0f, whole_a = 0.0f, whole_b = 0.0f;
    for (int c = 0; c < 3; ++c) {
        float a = row_load_one(irradiance_row(shown, c, stride), pixel);
        float b = probes[c * params.probe_stride + probe];
        apart += fabs(b - a);
        whole_a += fabs(a);
        whole_b += fabs(b);
        probes[c * params.probe_stride + probe] = b - a;
    }
    probes[3 * params.probe_stride + probe] = whole_a;
    int agrees = is_finite(apart) && apart <= params.threshold * fmax(whole_a, whole_b);
    uint state = agrees ? PROBE_AGREES : PROBE_FAILS;
    states[probe] = ids[GBUFFER_TRIANGLE * stride + pixel] >= 0 ? state : PROBE_NOWHERE;
}
