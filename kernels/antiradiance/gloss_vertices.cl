// What arrives at vertices that glossy leaves share, bin by bin: the mean over those leaves,
// weighted by area.                                            [Dachsbacher07, section 4.3]
//
// Work size    1D, one work-item a vertex; any local size; tail guarded
// Writes       the row of its vertex; what is not finite stays so
// SPDX-License-Identifier: MIT
#include "antiradiance/lobe.clh"

kernel void antiradiance_gloss_vertices(
    const ElementParams params,                 // count: vertices
    global const uint*  restrict first_leaves,  // [vertices + 1] in leaves
    global const uint2* restrict leaves,        // glossy leaf, and the bits of its share
    global const float* restrict arriving,      // [glossy leaves][3][ROW_BINS] radiance
    global float*       restrict light)         // [vertices][3][ROW_BINS]
{
    uint vertex = (uint)get_global_id(0);
    if (vertex >= params.count) return;
    for (uint bin = 0; bin < 3 * ROW_BINS; bin += CLGI_WIDTH) {
        floatp sum = packet_zero;
        for (uint i = first_leaves[vertex]; i < first_leaves[vertex + 1]; ++i)
            sum = fma(packet_splat(as_float(leaves[i].y)),
                      packet_load(arriving + (ulong)leaves[i].x * 3 * ROW_BINS + bin), sum);
        packet_store(sum, light + (ulong)vertex * 3 * ROW_BINS + bin);
    }
}
