// What records have around them, once the light between them is known: the radiance in each pixel of
// their hemicubes, and its means over blocks of pixels.
//
//   L = L_sky, or L_e + D + rho/pi E, or 0 beneath the record's surface
//                                           E: of records (lookup.clh), D: direct light that the
//                                           surface reflects towards the record (link.clh)
//                                      [Krivanek05: radiance that is cached; derived: in hemicubes]
//
// Work size    1D, one work-item a face, five a slot; any local size; tail guarded
// Writes       its own pixels, at all levels
// Cost         as link.cl a pixel
// SPDX-License-Identifier: MIT
#include "cache/around.clh"
#include "cache/link.clh"

// From pixel k, exposed; 0 where there is nothing. found: irradiance of what the pixels see.
static float3 around_radiance(const LinkWorld* world, const View* view, const LinkPacket* packet,
                              const float found[3][CLGI_WIDTH], int k) {
    if (packet->at.seen[k] >= 0)
        return link_radiance(world, packet, found, link_shares(world, packet, k), k);
    return link_above(world, view, &packet->at, 0, k) * world->params->sky.xyz *
           (1.0f / packet->at.factor[k]);
}

kernel void cache_around(
    RECORD_WORLD_ARGUMENTS,
    const CacheAround    of,
    global const float*  restrict light,   // [3][stride] exposed lux
    global uint2*        restrict around)  // [pixels of all levels] (around.clh), exposed radiance
{
    uint item = (uint)get_global_id(0), slot = item / 5, face = item % 5;
    if (slot >= of.slots) return;
    LinkWorld world = LINK_WORLD;
    uint record = slot < of.seen ? slot : slot + of.met;
    int stands = link_stands(&params, planes, record);
    View view = views[5 * record + face];
    uint across = view.width / params.every, down = view.height / params.every;
    uint before = face == 0 ? 0 : face + 1, to = around_face(of.size, slot, before);
    uint pixels = across * down;
    for (uint pixel = 0; pixel < pixels; pixel += CLGI_WIDTH) {
        LinkPacket packet;
        float found[3][CLGI_WIDTH];
        if (stands) {
            link_packet(&world, &view, visibility, record, face, pixel,
                        link_block(record, face, pixel), &packet);
            CacheVector there = cache_light(&packet.share, light, tree.stride);
            packet_store(there.x, found[0]);
            packet_store(there.y, found[1]);
            packet_store(there.z, found[2]);
        }
        for (int k = 0; k < CLGI_WIDTH; ++k)
            around[to + pixel + k] =
                stands ? around_pack(around_radiance(&world, &view, &packet, found, k)) : (uint2)(0);
    }
    for (uint level = 1; level < AROUND_LEVELS; ++level) {
        uint from = to, width = across >> level, count = width * (down >> level);
        to = around_first(of.slots, of.size, level) + around_face(of.size >> level, slot, before);
        for (uint pixel = 0; pixel < count; pixel += CLGI_WIDTH) {
            int at[CLGI_WIDTH];
            for (uint k = 0; k < CLGI_WIDTH; ++k) {
                uint of_pixel = min(pixel + k, count - 1);
                at[k] = (int)(from + of_pixel / width * 4 * width + of_pixel % width * 2);
            }
            CacheVector sum = {packet_zero, packet_zero, packet_zero};
            for (uint part = 0; part < 4; ++part) {
                CacheVector of_part = around_unpack(around + (part / 2 * 2 * width + part % 2), at);
                sum.x += of_part.x;
                sum.y += of_part.y;
                sum.z += of_part.z;
            }
            float mean[3][CLGI_WIDTH];
            packet_store(0.25f * sum.x, mean[0]);
            packet_store(0.25f * sum.y, mean[1]);
            packet_store(0.25f * sum.z, mean[2]);
            for (uint k = 0; k < CLGI_WIDTH && pixel + k < count; ++k)
                around[to + pixel + k] = around_pack(link_lane(mean, (int)k));
        }
    }
}
