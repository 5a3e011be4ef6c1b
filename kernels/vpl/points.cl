// The points at which a site is looked at when others shoot: the first of its sample points, beside
// those of its neighbours, so that a packet of them holds several sites.
//                                                             [derived: Schaerfig16, section 3.3]
//
// Work size    1D, one work-item a point; any local size; tail guarded
// Writes       its own planes; 0 where the site has no such sample: nothing faces that
// Cost         36 bytes read and written a point
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/vpl.h"

kernel void vpl_points(
    const PointParams      params,
    global const Site*     restrict sites,    // [site_count]
    global const float*    restrict samples,  // [GBUFFER_PLANES][sample_stride]
    global float*          restrict points)   // [SITE_POINT_PLANES][stride]
{
    uint point = (uint)get_global_id(0);
    if (point >= params.stride) return;
    uint site = point / params.per_site, k = point % params.per_site;
    bool there = site < params.site_count && k < min(sites[site].sample_count, params.most_samples);
    uint from = there ? sites[site].first_sample + k : 0;
    const uint planes[3] = {GBUFFER_POSITION, GBUFFER_NORMAL, GBUFFER_GEOMETRIC};
    for (uint i = 0; i < 3; ++i)
        for (uint c = 0; c < 3; ++c)
            points[(3 * i + c) * params.stride + point] =
                there ? samples[(planes[i] + c) * params.sample_stride + from] : 0.0f;
}
