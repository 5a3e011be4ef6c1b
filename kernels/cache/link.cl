// What arrives at records from all that their hemicubes see: a row of the transport, and what does
// not depend on other records, the light of the sky and of emission, and direct light once reflected.
//
//   E_i = B_i + R_i + sum_j T_ij E_j
//   T_ij = sum over pixels w rho W_j,   B_i = sum w pi L,   R_i = sum w pi D
//
// w: form factor of a pixel, rho: albedo of the surface in it, lobes taken for diffuse, W_j: share of
// record j in it (lookup.clh), D: radiance that it reflects of direct light towards the record, by
// shadow maps (lights/direct.clh) and lobes (microfacet.clh). E has no direct light but that of the
// sky. Of bright parts of the sky that pixels are lit by directions of, `bright` says what they bring.
// Sample points of emissive surfaces, of which there may be hundreds, take turns from one block of
// 16 pixels to the next.        [derived: radiosity of points, gathered by hemicubes]
//
// Work size    1D, one work-item a record; any local size; tail guarded
// Writes       its own row and its own base light
// Cost         some 300 flops a pixel that shows a surface, and 60 for each emitter; 60 and a look-up
//              one that shows the sky
// SPDX-License-Identifier: MIT
#include "cache/link.clh"

kernel void cache_link(RECORD_LINK_ARGUMENTS) {
    uint item = (uint)get_global_id(0);
    if (item >= params.count) return;
    LinkWorld world = LINK_WORLD;
    uint record = params.first + item;
    uint stride = params.stride;
    global float* row = rows + (ulong)record * 3 * stride;
    for (uint k = 0; k < 3 * stride; ++k) row[k] = 0.0f;
    float3 own = (float3)(0.0f), above = (float3)(0.0f), once = (float3)(0.0f);
    float3 beyond = (float3)(0.0f);
    float all = 0.0f;
    int stands = link_stands(&params, planes, record);
    for (uint face = 0; stands && face < 5; ++face) {
        View view = views[5 * record + face];
        uint pixels = view.width * view.height;
        for (uint pixel = 0; pixel < pixels; pixel += CLGI_WIDTH) {
            uint block = link_block(record, face, pixel);
            if (!link_counts(&params, block, pixel)) continue;
            LinkPacket packet;
            link_packet(&world, &view, visibility, face, pixel, block, &packet);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                all += packet.factor[k];
                above += link_above(&world, &view, &packet, 0, k);
                if (params.bright) beyond += link_above(&world, &view, &packet, 1, k);
                float3 sends, reflects;
                CacheShare share;
                if (!link_surface(&world, &packet, k, &sends, &reflects, &share)) continue;
                own += sends;
                once += packet.factor[k] * link_lane(packet.once, k);
                for (uint i = 0; i < share.count; ++i) {
                    global float* to = row + share.record[i];
                    to[0] += share.weight[i] * reflects.x;
                    to[stride] += share.weight[i] * reflects.y;
                    to[2 * stride] += share.weight[i] * reflects.z;
                }
            }
        }
    }
    // The pixels' form factors sum to 1 but for the midpoint rule.
    float scale = all > 0.0f ? 1.0f / all : 0.0f;
    for (uint k = 0; k < 3 * stride; ++k) row[k] *= scale;
    beyond *= scale * CLGI_PI * params.sky.xyz;
    own = scale * (own + CLGI_PI * above * params.sky.xyz) + beyond;
    base[record] = own.x;
    base[stride + record] = own.y;
    base[2 * stride + record] = own.z;
    bright[record] = beyond.x;
    bright[stride + record] = beyond.y;
    bright[2 * stride + record] = beyond.z;
    reflected[record] = scale * once.x;
    reflected[stride + record] = scale * once.y;
    reflected[2 * stride + record] = scale * once.z;
}
