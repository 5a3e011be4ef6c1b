// The form of link for groups: a record belongs to a group, a pixel to a lane. What lanes found they
// leave in local memory; each then adds up, in the order of pixels, one of the sums and the shares of
// those records whose number is its own, modulo the lanes. So no sum has another order than in link.
//                                      [derived: as link.cl]
//
// Work size    1D, one group a record; at most 64 lanes a group
// Writes       its own row and its own base light
// SPDX-License-Identifier: MIT
#include "cache/link.clh"

#define MOST_LANES 64
// Of form factors, in three channels of B, R, the sky and its bright part, and of form factors of surfaces
// and of those surfaces that are looked at.
#define SUMS 15

kernel void cache_link_group(RECORD_LINK_ARGUMENTS) {
    local float brings[SUMS][MOST_LANES];
    local float reflects[3][MOST_LANES];
    local uint count[MOST_LANES], records[CACHE_FEW][MOST_LANES];
    local float weights[CACHE_FEW][MOST_LANES];
    local float sums[SUMS];
    LinkWorld world = LINK_WORLD;
    uint lane = (uint)get_local_id(0), lanes = (uint)get_local_size(0);
    uint record = params.first + (uint)get_group_id(0);
    uint stride = params.stride, across = params.row_stride;
    global float* row = rows + (ulong)record * 3 * across;
    for (uint k = 0; k < 3; ++k)
        for (uint j = lane; j < across; j += lanes) row[k * across + j] = 0.0f;
    for (uint k = lane; k < SUMS; k += lanes) sums[k] = 0.0f;
    uint faces = link_stands(&params, planes, record) ? 5 : 0;
    uint skies = params.sky_width > 0, every = params.every;
    // The sky, if there is one, and then surfaces: part 0 and 1 of five faces each.
    for (uint turn = skies ? 0 : 5; faces > 0 && turn < 10; ++turn) {
        uint face = turn % 5, part = turn / 5;
        View view = views[5 * record + face];
        uint pixels = view.width * view.height / (part ? every * every : 1);
        for (uint first = 0; first < pixels; first += lanes) {
            uint pixel = first + lane, block = link_block(record, face, pixel);
            for (uint k = 0; k < SUMS; ++k) brings[k][lane] = 0.0f;
            count[lane] = 0;
            int counts = pixel < pixels && link_counts(&params, block, pixel);
            if (counts && !part) {
                LinkPixels at;
                link_pixels(&world, &view, visibility, record, face, pixel, &at);
                float3 above = link_above(&world, &view, &at, 0, 0), beyond = (float3)(0.0f);
                if (params.bright) beyond = link_above(&world, &view, &at, 1, 0);
                brings[0][lane] = at.factor[0];
                brings[7][lane] = above.x;
                brings[8][lane] = above.y;
                brings[9][lane] = above.z;
                brings[10][lane] = beyond.x;
                brings[11][lane] = beyond.y;
                brings[12][lane] = beyond.z;
                brings[13][lane] = at.seen[0] >= 0 ? at.factor[0] : 0.0f;
            } else if (counts) {
                LinkPacket packet;
                link_packet(&world, &view, visibility, record, face, pixel, block, &packet);
                if (!skies) brings[0][lane] = packet.at.factor[0];
                brings[14][lane] = packet.at.seen[0] >= 0 ? packet.at.factor[0] : 0.0f;
                float3 sends, rho;
                if (link_surface(&world, &packet, 0, link_shares(&world, &packet, 0), &sends, &rho)) {
                    float3 once = packet.at.factor[0] * link_lane(packet.once, 0);
                    brings[1][lane] = sends.x;
                    brings[2][lane] = sends.y;
                    brings[3][lane] = sends.z;
                    brings[4][lane] = once.x;
                    brings[5][lane] = once.y;
                    brings[6][lane] = once.z;
                    reflects[0][lane] = rho.x;
                    reflects[1][lane] = rho.y;
                    reflects[2][lane] = rho.z;
                    count[lane] = packet.share.count;
                    for (uint i = 0; i < packet.share.count; ++i) {
                        records[i][lane] = (uint)packet.share.record[i][0];
                        weights[i][lane] = packet.weight[i][0];
                    }
                }
            }
            barrier(CLK_LOCAL_MEM_FENCE);
            for (uint k = lane; k < SUMS; k += lanes)
                for (uint of = 0; of < lanes; ++of) sums[k] += brings[k][of];
            for (uint of = 0; of < lanes; ++of)
                for (uint i = 0; i < count[of]; ++i) {
                    uint at = records[i][of];
                    if (at % lanes != lane) continue;
                    row[at] += weights[i][of] * reflects[0][of];
                    row[across + at] += weights[i][of] * reflects[1][of];
                    row[2 * across + at] += weights[i][of] * reflects[2][of];
                }
            barrier(CLK_LOCAL_MEM_FENCE);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    // The pixels' form factors sum to 1 but for the midpoint rule.
    float all = sums[0], scale = all > 0.0f ? 1.0f / all : 0.0f, stand_for = scale;
    if (skies) stand_for = sums[14] > 0.0f ? scale * sums[13] / sums[14] : 0.0f;
    for (uint k = 0; k < 3; ++k)
        for (uint j = lane; j < across; j += lanes) row[k * across + j] *= stand_for;
    if (lane != 0) return;
    float sky_scale[3] = {params.sky.x, params.sky.y, params.sky.z};
    for (uint c = 0; c < 3; ++c) {
        float beyond = sums[10 + c] * (scale * CLGI_PI * sky_scale[c]);
        base[c * stride + record] =
            stand_for * sums[1 + c] + scale * CLGI_PI * sums[7 + c] * sky_scale[c] + beyond;
        bright[c * stride + record] = beyond;
        reflected[c * stride + record] = stand_for * sums[4 + c];
    }
}
