// The table of half-spaces as masks: bits of the directions in front of a plane through the eye.
//
// Entry (face, row, column) is the plane whose normal has 1 as component `face`, and u and v of the
// texel's centre as the next two, cyclically [Kautz04, section 3.1.1]. Three faces of the cube are
// stored: the normals of the other three are opposite, and their masks the complement.
//
// A plane is off by at most atan(sqrt(2) / Q) for a table of 3 x Q x Q.
//                                               [derived: half the diagonal of a texel, at 1]
//
// Work size    1D, one work-item an entry; any local size; tail guarded
// Writes       its own entry
// SPDX-License-Identifier: MIT
#include "transfer/half_plane.clh"

kernel void transfer_planes(
    const uint             size,    // Q
    global const float*    restrict heights,  // [CLGI_MASK][MASK_COLUMNS] z of pixels
    global uint*           restrict table)    // [PLANE_FACES][Q][Q][MASK_WORDS]
{
    uint entry = (uint)get_global_id(0);
    if (entry >= PLANE_FACES * size * size) return;
    float u = (float)(2 * (entry % size) + 1) / (float)size - 1.0f;
    float v = (float)(2 * (entry / size % size) + 1) / (float)size - 1.0f;
    uint face = entry / (size * size);
    float3 normal = face == 0 ? (float3)(1.0f, u, v)
                  : face == 1 ? (float3)(v, 1.0f, u)
                              : (float3)(u, v, 1.0f);
    for (int word = 0; word < ROW_WORDS; ++word)
        for (int packet = 0; packet < COLUMN_PACKETS; ++packet) {
            floatp along = packet_splat(normal.x) * column_x(packet);
            uintp bits = (uintp)(0);
            for (int row = 32 * word; row < min(32 * word + 32, CLGI_MASK); ++row) {
                floatp z = packet_load(heights + row * MASK_COLUMNS(CLGI_MASK) +
                                       packet * CLGI_WIDTH);
                floatp front = fma(packet_splat(normal.z), z,
                                   fma(packet_splat(normal.y), packet_splat(row_y(row)), along));
                bits |= packet_select((uintp)(0), (uintp)(1u << (row & 31)), front > packet_zero);
            }
            uint at = (entry * ROW_WORDS + word) * MASK_COLUMNS(CLGI_MASK) + packet * CLGI_WIDTH;
            packet_store(bits & disc_word(word, packet), table + at);
        }
}
