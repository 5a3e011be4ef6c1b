// Factors of the receivers that bring the light from all sides to the share of the hemisphere in
// which there are surfaces: one half-step of a balancing of rows and columns.
//
//   b_j = h_j / sum_i a_i T_ij A_i                     [derived: Sinkhorn, Knopp 1967]
//
// A site can only be out of balance by what the sampling misses, so a factor stays within
// [1/BALANCE_MOST, BALANCE_MOST]: a site that nothing reaches is not made to shine.
//
// Work size    1D, one work-item for every CLGI_WIDTH receivers; any local size; tail guarded
// Writes       its own factors
// SPDX-License-Identifier: MIT
#include "vpl/balance.clh"

kernel void vpl_balance_receivers(
    const ShootParams    params,
    global const Site*   restrict sites,    // [site_count]
    global const half*   restrict rows,     // [site_count][stride]
    global float*        restrict balance)  // [BALANCE_PLANES][stride]
{
    uint at = (uint)get_global_id(0) * CLGI_WIDTH;
    if (at >= params.site_count) return;
    uint stride = params.stride;
    floatp sum = packet_zero;
    for (uint i = 0; i < params.site_count; ++i)
        sum = fma(balance_row(rows, stride, i, at),
                  packet_splat(balance[BALANCE_SHOOTER * stride + i] * sites[i].area *
                               SITE_ROW_UNIT(sites[i].flags)),
                  sum);
    floatp reach = packet_load(balance + BALANCE_REACH * stride + at);
    packet_store(balance_factor(reach, sum * params.per_row_scale),
                 balance + BALANCE_RECEIVER * stride + at);
}
