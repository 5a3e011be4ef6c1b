// The direct irradiance of each site: the mean over its sample points, each lit and shadowed on its
// own. That is Eq. 5 with the form factor and the visibility of every sample instead of the VPL's
// form factor times the share of samples that are lit.            [Schaerfig16, Eq. 5, 6]
//
// Work size    1D, one work-item a site; any local size; tail guarded
// Writes       its own light: the same irradiance as unshot and as received
// SPDX-License-Identifier: MIT
#include "clgi/shared/vpl.h"

kernel void vpl_receive(
    const SiteParams     params,
    global const Site*   restrict sites,       // [site_count]
    global const float*  restrict irradiance,  // [IRRADIANCE_PLANES][sample_stride] lux, exposed
    global float*        restrict light)       // [SITE_LIGHT_PLANES][stride]
{
    uint site = (uint)get_global_id(0);
    if (site >= params.site_count) return;
    Site own = sites[site];
    for (uint c = 0; c < 3; ++c) {
        global const float* at = irradiance + c * params.sample_stride + own.first_sample;
        float sum = 0.0f;
        for (uint k = 0; k < own.sample_count; ++k) sum += at[k];
        sum /= (float)own.sample_count;
        light[(SITE_UNSHOT + c) * params.stride + site] = sum;
        light[(SITE_RECEIVED + c) * params.stride + site] = sum;
    }
}
