// Sites from the surface: where each VPL is, which way it faces, and what it reflects: the mean over
// its sample points, so that a texture counts by area.             [Schaerfig16, section 3.1]
//
// Work size    1D, one work-item a site; any local size; tail guarded
// Writes       its own planes; the base colours of its samples become reflectances, and on the back
//              of a triangle their normals are turned
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/scene.h"
#include "clgi/shared/vpl.h"

kernel void vpl_place(
    const SiteParams               params,
    global const Site*             restrict sites,      // [site_count]
    global const MaterialRecord*   restrict materials,
    global const int*              restrict ids,        // [GBUFFER_ID_PLANES][sample_stride]
    global float*                  restrict samples,    // [GBUFFER_PLANES][sample_stride], of
                                                        // sample_count samples and then the sites
    global float*                  restrict planes)     // [SITE_PLANES][stride]
{
    uint site = (uint)get_global_id(0);
    if (site >= params.site_count) return;
    uint stride = params.stride, sample_stride = params.sample_stride;
    Site own = sites[site];
    float sign = own.flags & SITE_BACK ? -1.0f : 1.0f;
    uint center = params.sample_count + site;
    for (uint c = 0; c < 3; ++c) {
        planes[(SITE_POSITION + c) * stride + site] =
            samples[(GBUFFER_POSITION + c) * sample_stride + center];
        planes[(SITE_NORMAL + c) * stride + site] =
            sign * samples[(GBUFFER_GEOMETRIC + c) * sample_stride + center];
    }
    float3 sum = (float3)(0.0f);
    for (uint k = 0; k < own.sample_count; ++k) {
        uint sample = own.first_sample + k;
        int material = ids[GBUFFER_MATERIAL * sample_stride + sample];
        float share = material < 0 ? 0.0f : materials[material].reflectance.x;
        global float* at = samples + sample;
        for (uint plane = GBUFFER_BASE; plane < GBUFFER_EMISSION; ++plane)
            at[plane * sample_stride] *= share;
        sum += (float3)(at[GBUFFER_BASE * sample_stride], at[(GBUFFER_BASE + 1) * sample_stride],
                        at[(GBUFFER_BASE + 2) * sample_stride]);
        for (uint plane = GBUFFER_NORMAL; plane < GBUFFER_BASE; ++plane)
            at[plane * sample_stride] *= sign;
    }
    sum = min(sum / (float)own.sample_count, (float3)(SITE_BRIGHTEST));
    planes[SITE_ALBEDO * stride + site] = sum.x;
    planes[(SITE_ALBEDO + 1) * stride + site] = sum.y;
    planes[(SITE_ALBEDO + 2) * stride + site] = sum.z;
}
