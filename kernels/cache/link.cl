// What arrives at records from all that their hemicubes see: a row of the transport, and what does
// not depend on other records, the light of the sky and of emission, and direct light once reflected.
//
//   E_i = B_i + R_i + sum_j T_ij E_j'
//   T_ij = sum over pixels w rho W_j,   B_i = sum w pi L,   R_i = sum w pi D
//                                             [derived: radiosity of points, gathered by hemicubes]
//
// w: form factor of a pixel, rho: albedo of the surface in it, lobes taken for diffuse, W_j: share of
// record j in it (lookup.clh), E': light that is sharpened for that (sharpen.cl), D: radiance that it
// reflects of direct light towards the record, by shadow maps (lights/direct.clh) and lobes
// (microfacet.clh). Pixels whose rays go beneath the surface that the record stands on bring nothing,
// but count in the sum of form factors. E has no direct light but that of the sky. Of bright parts of
// the sky that pixels are lit by directions of, `bright` says what they bring. Sample points of emissive
// surfaces, of which there may be hundreds, take turns in blocks of 16 pixels (link_turn).
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
    uint stride = params.stride, across = params.row_stride;
    global float* row = rows + (ulong)record * 3 * across;
    for (uint k = 0; k < 3 * across; ++k) row[k] = 0.0f;
    int stands = link_stands(&params, planes, record), skies = params.sky_width > 0;
    // Of form factors: all, of surfaces, and of those surfaces that are looked at.
    float all = 0.0f, surfaces = 0.0f, looked = 0.0f;
    float3 above = (float3)(0.0f), beyond = (float3)(0.0f);
    for (uint face = 0; stands && skies && face < 5; ++face) {
        View view = views[5 * record + face];
        uint pixels = view.width * view.height;
        for (uint pixel = 0; pixel < pixels; pixel += CLGI_WIDTH) {
            if (!link_counts(&params, link_block(record, face, pixel), pixel)) continue;
            LinkPixels at;
            link_pixels(&world, &view, visibility, record, face, pixel, &at);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                all += at.factor[k];
                surfaces += at.seen[k] >= 0 ? at.factor[k] : 0.0f;
                above += link_above(&world, &view, &at, 0, k);
                if (params.bright) beyond += link_above(&world, &view, &at, 1, k);
            }
        }
    }
    float3 own = (float3)(0.0f), once = (float3)(0.0f);
    for (uint face = 0; stands && face < 5; ++face) {
        View view = views[5 * record + face];
        uint pixels = view.width * view.height / (params.every * params.every);
        for (uint pixel = 0; pixel < pixels; pixel += CLGI_WIDTH) {
            uint block = link_block(record, face, pixel);
            if (!link_counts(&params, block, pixel)) continue;
            LinkPacket packet;
            link_packet(&world, &view, visibility, record, face, pixel, block, &packet);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                if (!skies) all += packet.at.factor[k];
                looked += packet.at.seen[k] >= 0 ? packet.at.factor[k] : 0.0f;
                float3 sends, reflects;
                if (!link_surface(&world, &packet, k, link_shares(&world, &packet, k), &sends,
                                  &reflects)) continue;
                own += sends;
                once += packet.at.factor[k] * link_lane(packet.once, k);
                for (uint i = 0; i < packet.share.count; ++i) {
                    global float* to = row + packet.share.record[i][k];
                    to[0] += packet.weight[i][k] * reflects.x;
                    to[across] += packet.weight[i][k] * reflects.y;
                    to[2 * across] += packet.weight[i][k] * reflects.z;
                }
            }
        }
    }
    // The pixels' form factors sum to 1 but for the midpoint rule.
    float scale = all > 0.0f ? 1.0f / all : 0.0f, stand_for = scale;
    if (skies) stand_for = looked > 0.0f ? scale * surfaces / looked : 0.0f;
    for (uint k = 0; k < 3 * across; ++k) row[k] *= stand_for;
    beyond *= scale * CLGI_PI * params.sky.xyz;
    own = stand_for * own + scale * CLGI_PI * above * params.sky.xyz + beyond;
    once *= stand_for;
    base[record] = own.x;
    base[stride + record] = own.y;
    base[2 * stride + record] = own.z;
    bright[record] = beyond.x;
    bright[stride + record] = beyond.y;
    bright[2 * stride + record] = beyond.z;
    reflected[record] = once.x;
    reflected[stride + record] = once.y;
    reflected[2 * stride + record] = once.z;
}
