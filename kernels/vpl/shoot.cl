// What the shooters sent arrives at all sites.
//
//   R = b_j sum_i a_i T_ij P_i,   dI_j <- dI_j + R,   I_j <- I_j + R        [Schaerfig16, Eq. 8]
//
// a, b: factors that balance the transport (balance_shooters.cl). The power that a site can send on
// is computed at once, for the choice of the next shooter (Eq. 7); of the three channels the sum
// counts.
//
// Work size    1D, one work-item for every CLGI_WIDTH receivers; any local size; tail guarded
// Writes       its own light and power; packets with numbers that are not finite are counted
// Cost         4 flops and 2 bytes a pair
// SPDX-License-Identifier: MIT
#include "vpl/balance.clh"

kernel void vpl_shoot(
    const ShootParams      params,
    global const uint*     restrict chosen,      // [first_shooter + shooter_count] sites
    global const Site*     restrict sites,       // [site_count]
    global const float*    restrict planes,      // [SITE_PLANES][stride]
    global const half*     restrict rows,        // [site_count or shooter_count][stride]
    global const float*    restrict balance,     // [BALANCE_PLANES][stride]
    global const float*    restrict shot,        // [3][stride]
    global float*          restrict light,       // [SITE_LIGHT_PLANES][stride]
    global float*          restrict power,       // [stride] unshot
    volatile global uint*  restrict non_finite)  // [1]
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.site_count) return;
    uint stride = params.stride;
    floatp sum[3] = {packet_zero, packet_zero, packet_zero};
    for (uint s = 0; s < params.shooter_count; ++s) {
        uint site = chosen[params.first_shooter + s];
        float factor = balance[BALANCE_SHOOTER * stride + site] *
                       SITE_ROW_UNIT(sites[site].flags) * params.per_row_scale;
        floatp transport = balance_row(rows, stride, params.kept ? site : s, at);
        for (int c = 0; c < 3; ++c)
            sum[c] = fma(transport, packet_splat(factor * shot[c * stride + site]), sum[c]);
    }
    floatp receiver = packet_load(balance + BALANCE_RECEIVER * stride + at);
    float area[CLGI_WIDTH];
    for (uint k = 0; k < CLGI_WIDTH; ++k)
        area[k] = at + k < params.site_count ? sites[at + k].area : 0.0f;
    floatp left = packet_zero;
    uintp worst = (uintp)(0);
    for (int c = 0; c < 3; ++c) {
        floatp gained = sum[c] * receiver;
        global float* unshot = light + (SITE_UNSHOT + c) * stride + at;
        global float* received = light + (SITE_RECEIVED + c) * stride + at;
        floatp now = packet_load(unshot) + gained;
        worst = max(worst, packet_magnitude(now));
        packet_store(now, unshot);
        packet_store(packet_load(received) + gained, received);
        left = fma(now, packet_load(planes + (SITE_ALBEDO + c) * stride + at), left);
    }
    packet_store(left * packet_load(area), power + at);
    intp bad = (as_intp(worst) >= NOT_FINITE) & ((int)at + packet_lanes < (int)params.site_count);
    if (packet_any(bad)) atomic_inc(non_finite);
}
