// The triangles that receivers see: those that are the nearest in at least one pixel of the mask
// (transfer/nearest.clh). They alone draw the same mask [Kautz04, section 3.2, PVS].
//
// Work size    1D, one work-item a receiver and packet of columns; any local size; tail guarded
// Writes       sets bits of its receiver; the others stay, so calls for several frames add up
// SPDX-License-Identifier: MIT
#include "transfer/nearest.clh"

kernel void transfer_visible(
    const MaskParams         params,
    global const float*      restrict receivers,  // [RECEIVER_PLANES][receiver_stride]
    BLOCKER_ARGUMENTS,
    global const float*      restrict heights,    // [CLGI_MASK][MASK_COLUMNS] z of pixels
    global uint*             restrict seen)       // [ceil(triangles / 32)][receiver_stride] bits
{
    uint receiver = (uint)get_global_id(0) / COLUMN_PACKETS;
    int packet = (int)((uint)get_global_id(0) % COLUMN_PACKETS);
    if (receiver >= params.receiver_count) return;
    Receiver r = load_receiver(receivers, params.receiver_stride, receiver);
    BlockerLists from = BLOCKER_LISTS;
    Nearest nearest;
    find_nearest(r, receiver, packet, params, from, heights, &nearest);
    for (int row = 0; row < CLGI_MASK; ++row) {
        uint triangle[CLGI_WIDTH];
        packet_store(packet_select(nearest.triangle[row] & ~FROM_BEHIND, nearest.triangle[row],
                                   nearest.triangle[row] == NO_TRIANGLE), triangle);
        for (int k = 0; k < CLGI_WIDTH; ++k) {
            if (triangle[k] == NO_TRIANGLE || (k > 0 && triangle[k] == triangle[k - 1])) continue;
            atomic_or(seen + triangle[k] / 32 * params.receiver_stride + receiver,
                      1u << (triangle[k] % 32));
        }
    }
}
