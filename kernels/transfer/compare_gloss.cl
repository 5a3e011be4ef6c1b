// How far the gloss at probes is from what is shown at their pixels, after transfer/compare_probes.cl.
//
// The difference replaces the light. A probe fails besides where, summed over channels,
//
//   k |G - G_shown| > threshold (d E_shown + k max(G, G_shown)),  or is not finite
//   d = diffuse share * base colour / pi,  k = (coat + lobe share * base colour) / lobe_mean
//
// so that gloss counts as much as it is seen. Nothing is missing where the material has no lobe.
//        [Kautz04, section 4.1, per-vertex sampling; derived: docs/materials.md, shares of a material]
//
// Work size    1D, one work-item a probe; any local size; tail guarded
// Writes       difference, what is shown, and state of its probe
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/receivers.h"
#include "clgi/shared/scene.h"
#include "detail_codes.clh"
#include "finite.clh"
#include "lobe_mean.clh"
#include "planes.clh"
#include "transfer/probe.clh"

kernel void transfer_compare_gloss(
    const ProbeParams    params,
    global const MaterialRecord* restrict materials,
    global const float*  restrict planes,      // [GBUFFER_PLANES][pixel_stride]
    global const int*    restrict ids,         // [GBUFFER_ID_PLANES][pixel_stride]
    global const float*  restrict irradiance,  // [3][pixel_stride] interpolated
    global const float*  restrict shown,       // [3][pixel_stride] gloss, interpolated
    global float*        restrict probes,      // [4][probe_stride] gloss -> what is missing, and the
                                               // sum of what is shown
    global uint*         restrict states)      // [columns * rows] PROBE_...
{
    uint probe = (uint)get_global_id(0);
    if (probe >= params.columns * params.rows) return;
    uint stride = params.pixel_stride, pixel = probe_pixel(params, probe);
    float4 share = pixel_reflectance(ids, materials, stride, pixel);
    share.yz /= lobe_mean(share.w);
    int has_lobe = share.y + share.z > 0.0f;
    float apart = 0.0f, whole_a = 0.0f, whole_b = 0.0f, rest = 0.0f, sum = 0.0f;
    for (int c = 0; c < 3; ++c) {
        float base = row_load_one(gbuffer_row(planes, GBUFFER_BASE + c, stride), pixel);
        float lobe = fma(share.z, base, share.y);
        float a = row_load_one(irradiance_row(shown, c, stride), pixel);
        float b = probes[c * params.probe_stride + probe];
        apart += lobe * fabs(b - a);
        whole_a += lobe * fabs(a);
        whole_b += lobe * fabs(b);
        rest += share.x * (1.0f / CLGI_PI) * base *
                fabs(row_load_one(irradiance_row(irradiance, c, stride), pixel));
        sum += fabs(a);
        probes[c * params.probe_stride + probe] = has_lobe ? b - a : 0.0f;
    }
    probes[3 * params.probe_stride + probe] = has_lobe ? sum : 0.0f;
    int agrees = is_finite(apart) && apart <= params.threshold * (rest + fmax(whole_a, whole_b));
    if (has_lobe && !agrees && states[probe] == PROBE_AGREES) states[probe] = PROBE_FAILS;
}
