// Factors of the shooters that bring the power that arrives to the power that is shot, less what
// leaves the scene: the other half-step.
//
//   a_i = h_i / sum_j T_ij b_j A_j                     [derived: Sinkhorn, Knopp 1967]
//
// Where the bounds of a factor do not allow that, the share that surfaces take is another one than
// was measured: what cannot arrive is lost. Then h_i <- a_i sum_j T_ij b_j A_j.
//
// Work size    1D, one work-item a shooter; any local size; tail guarded
// Writes       its own factor, and BALANCE_REACH where it was out of reach
// SPDX-License-Identifier: MIT
#include "vpl/balance.clh"

kernel void vpl_balance_shooters(
    const ShootParams    params,
    global const uint*   restrict chosen,   // [first_shooter + shooter_count] sites
    global const Site*   restrict sites,    // [site_count]
    global const half*   restrict rows,     // [site_count or shooter_count][stride]
    global float*        restrict balance)  // [BALANCE_PLANES][stride]
{
    uint s = (uint)get_global_id(0);
    if (s >= params.shooter_count) return;
    uint stride = params.stride;
    uint site = chosen[params.first_shooter + s];
    floatp sum = packet_zero;
    for (uint at = 0; at < params.site_count; at += CLGI_WIDTH) {
        float lane[CLGI_WIDTH];
        for (uint k = 0; k < CLGI_WIDTH; ++k)
            lane[k] = at + k < params.site_count ? sites[at + k].area : 0.0f;
        floatp weight = packet_load(lane) * packet_load(balance + BALANCE_RECEIVER * stride + at);
        intp there = (int)at + packet_lanes < (int)params.site_count;
        sum += packet_select(packet_zero,
                             balance_row(rows, stride, params.kept ? site : s, at) * weight, there);
    }
    float lane[CLGI_WIDTH];
    packet_store(sum, lane);
    float total = 0.0f;
    for (int k = 0; k < CLGI_WIDTH; ++k) total += lane[k];
    float reach = balance[BALANCE_REACH * stride + site];
    float all = total * SITE_ROW_UNIT(sites[site].flags) * params.per_row_scale;
    float lanes[CLGI_WIDTH];
    packet_store(balance_factor(packet_splat(reach), packet_splat(all)), lanes);
    balance[BALANCE_SHOOTER * stride + site] = lanes[0];
    if (lanes[0] * BALANCE_MOST <= 1.0f || lanes[0] >= BALANCE_MOST || !(all > 0.0f))
        balance[BALANCE_REACH * stride + site] = lanes[0] * all;
}
