// The shooters give away what they have not shot yet.
//
//   P_i = rho_i A_i dI_i,   dI_i <- 0                        [Schaerfig16, Eq. 7, 8]
//
// With SHOOT_STRONGEST there is one shooter, the site of the largest unshot power that arg_max has
// found; it becomes chosen[first_shooter], and shoots nothing if that power is below the threshold.
//
// Work size    1D, one work-item a site (SHOOT_STRONGEST: one); any local size; tail guarded
// Writes       its own shot power, unshot irradiance and power; chosen with SHOOT_STRONGEST
// SPDX-License-Identifier: MIT
#include "clgi/shared/parallel.h"
#include "clgi/shared/vpl.h"

kernel void vpl_emit(
    const ShootParams       params,
    global const ArgMax*    restrict strongest,  // [1]
    global const Site*      restrict sites,      // [site_count]
    global const float*     restrict planes,     // [SITE_PLANES][stride]
    global float*           restrict light,      // [SITE_LIGHT_PLANES][stride]
    global float*           restrict power,      // [stride] unshot power, exposed lumen
    global float*           restrict shot,       // [3][stride] exposed lumen
    global uint*            restrict chosen)     // [first_shooter + 1], SHOOT_STRONGEST
{
    uint site = (uint)get_global_id(0);
    if (site >= (params.mode == SHOOT_STRONGEST ? 1 : params.site_count)) return;
    int enough = 1;
    if (params.mode == SHOOT_STRONGEST) {
        enough = strongest->index < params.site_count && strongest->value > params.threshold;
        site = enough ? strongest->index : 0;
        chosen[params.first_shooter] = site;
    }
    uint stride = params.stride;
    for (uint c = 0; c < 3; ++c) {
        global float* unshot = light + (SITE_UNSHOT + c) * stride + site;
        float albedo = planes[(SITE_ALBEDO + c) * stride + site];
        shot[c * stride + site] = enough ? albedo * sites[site].area * *unshot : 0.0f;
        if (enough) *unshot = 0.0f;
    }
    if (enough) power[site] = 0.0f;
}
