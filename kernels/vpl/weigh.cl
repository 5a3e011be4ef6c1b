// How the sample points of a site share the power that it reflects.
//
//   w_k = L(rho_k (E_k + I - E)) m / sum_k L(...)         L: luminance
//
// E_k: direct irradiance of the sample, E: its mean, I: all irradiance of the site. What arrives by
// reflection is taken for even over the site; direct light has edges, which show near by.
//                                                         [derived: refined near field, exchange.clh]
//
// Work size    1D, one work-item a site; any local size; tail guarded
// Writes       the weights of its own samples, 1 on average
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/vpl.h"

static float3 weigh_planes(global const float* planes, uint stride) {
    return (float3)(planes[0], planes[stride], planes[2 * stride]);
}

kernel void vpl_weigh(
    const SiteParams     params,
    global const Site*   restrict sites,       // [site_count]
    global const float*  restrict irradiance,  // [IRRADIANCE_PLANES][sample_stride] lux, exposed
    global const float*  restrict light,       // [SITE_LIGHT_PLANES][stride]
    global const float*  restrict samples,     // [GBUFFER_PLANES][sample_stride]
    global float*        restrict weights)     // [sample_stride]
{
    uint site = (uint)get_global_id(0);
    if (site >= params.site_count) return;
    Site own = sites[site];
    uint stride = params.sample_stride;
    uint last = own.first_sample + own.sample_count;
    float count = (float)own.sample_count;
    float3 mean = (float3)(0.0f);
    for (uint k = own.first_sample; k < last; ++k) mean += weigh_planes(irradiance + k, stride);
    float3 reflected = weigh_planes(light + SITE_RECEIVED * params.stride + site, params.stride) -
                       mean / count;
    float sum = 0.0f;
    for (uint k = own.first_sample; k < last; ++k) {
        float3 all = weigh_planes(irradiance + k, stride) + reflected;
        float3 albedo = weigh_planes(samples + GBUFFER_BASE * stride + k, stride);
        float value = max(dot(albedo * all, (float3)(0.2126f, 0.7152f, 0.0722f)), 0.0f);
        weights[k] = value;
        sum += value;
    }
    // Light too dark or too bright to divide by, or no number at all, is shared evenly.
    int usable = sum > 1e-30f && sum < 1e30f;
    for (uint k = own.first_sample; k < last; ++k)
        weights[k] = usable ? weights[k] * (count / sum) : 1.0f;
}
