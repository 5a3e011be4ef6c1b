// The triangles that receivers see: those that are the nearest in at least one pixel of the mask.
// They alone draw the same mask [Kautz04, section 3.2, PVS].
//
// With unit vectors a', b', c' to the corners, whose distances are |a|, |b|, |c|, the plane of the
// triangle lies at distance t in the direction s:
//
//   1 / t = (s . (b' x c') / |a| + s . (c' x a') / |b| + s . (a' x b') / |c|) / a' . (b' x c')
//                          [derived: s t is a mean of the corners, and its weights add up to 1]
//
// So 1 / t is a product with one vector for each triangle, and the largest is the nearest. Pixels
// are inside by the same planes as in transfer/mask.cl. Of two triangles at the same distance the
// first in the list is seen. With CLGI_NEAR the receiver's single triangles follow its clusters.
//
// Work size    1D, one work-item a receiver and packet of columns; any local size; tail guarded
// Writes       sets bits of its receiver; the others stay, so calls for several frames add up
// SPDX-License-Identifier: MIT
#include "transfer/lanes.clh"

#define NO_TRIANGLE 0xffffffffu
#define LARGEST_NEARNESS 0x7149f2cau  // bits of 1e30: no sum of three overflows

typedef struct {
    floatp nearness[CLGI_MASK];  // 1 / t
    uintp triangle[CLGI_MASK];
} Nearest;

// The vector whose product with a direction is 1 / t. Of a triangle so narrow that it overflows, 0:
// it lies behind all others, and is still drawn where there are none.
CLGI_INLINE void nearness_vector(const Cones* cones, floatp* vector) {
    for (int axis = 0; axis < 3; ++axis) {
        floatp sum = packet_zero;
        for (int corner = 0; corner < 3; ++corner)
            sum = fma(cones->normal[(corner + 1) % 3][axis], cones->shrink[corner], sum);
        sum /= cones->turn;
        vector[axis] = packet_select(packet_zero, sum, packet_magnitude(sum) < LARGEST_NEARNESS);
    }
}

CLGI_INLINE void draw(const Lanes* lanes, int k, float3 toward, uint triangle, int packet,
                      global const float* restrict heights, Nearest* nearest) {
    Edges edges = lane_edges(lanes, k);
    floatp x = column_x(packet);
    floatp along[3];
    for (int e = 0; e < 3; ++e) along[e] = packet_splat(edges.x[e]) * x;
    for (int row = lanes->first_row[k]; row <= lanes->last_row[k]; ++row) {
        floatp z = packet_load(heights + row * MASK_COLUMNS(CLGI_MASK) + packet * CLGI_WIDTH);
        floatp y = packet_splat(row_y(row));
        floatp nearness = packet_dot(packet_splat(toward.x), packet_splat(toward.y),
                                     packet_splat(toward.z), x, y, z);
        intp nearer = inside_edges(edges, along, y, z) & (z > packet_zero) &
                      (nearness > nearest->nearness[row]);
        nearest->nearness[row] = packet_select(nearest->nearness[row], nearness, nearer);
        nearest->triangle[row] = packet_select(nearest->triangle[row], (uintp)(triangle), nearer);
    }
}

// index: triangles of the packet. triangle: 0, or index where it is no run.
CLGI_INLINE void draw_packet(Receiver r, global const float* corners, uint stride,
                             const uint* triangle, const uint* index, int packet,
                             global const float* restrict heights, Nearest* nearest) {
    Cones cones;
    if (!make_cones(r, corners, stride, triangle, &cones)) return;
    cones.alive &= (cones.first_column < (intp)((packet + 1) * CLGI_WIDTH)) &
                   (cones.last_column >= (intp)(packet * CLGI_WIDTH));
    if (!packet_any(cones.alive)) return;
    Lanes lanes;
    to_lanes(&cones, 0, &lanes);
    floatp vector[3];
    nearness_vector(&cones, vector);
    float toward[3][CLGI_WIDTH];
    for (int axis = 0; axis < 3; ++axis) packet_store(vector[axis], toward[axis]);
    for (int k = 0; k < CLGI_WIDTH; ++k)
        if (lanes.alive[k])
            draw(&lanes, k, (float3)(toward[0][k], toward[1][k], toward[2][k]), index[k], packet,
                 heights, nearest);
}

kernel void transfer_visible(
    const MaskParams         params,
    global const float*      restrict receivers,  // [RECEIVER_PLANES][receiver_stride]
    global const uint*       restrict lists,      // [lists + 1] first range of each list
    global const uint2*      restrict ranges,     // clusters of blockers: first and number
    global const BlockerBox* restrict boxes,      // one a cluster
    global const float*      restrict corners,    // [BLOCKER_PLANES][blocker_stride]
    global const float*      restrict heights,    // [CLGI_MASK][MASK_COLUMNS] z of pixels
#ifdef CLGI_NEAR
    global const uint*       restrict near_lists, // [receiver_count + 1] where lists begin in near
    global const uint*       restrict near_ones,  // single triangles of the lists
#endif
    global uint*             restrict seen)       // [ceil(triangles / 32)][receiver_stride] bits
{
    uint receiver = (uint)get_global_id(0) / COLUMN_PACKETS;
    int packet = (int)((uint)get_global_id(0) % COLUMN_PACKETS);
    if (receiver >= params.receiver_count) return;
    Receiver r = load_receiver(receivers, params.receiver_stride, receiver);
    Nearest nearest;
    for (int row = 0; row < CLGI_MASK; ++row) {
        nearest.nearness[row] = packet_splat(-FLT_MAX);
        nearest.triangle[row] = (uintp)(NO_TRIANGLE);
    }
    uint list = receiver / params.receivers_per_list;
    for (uint i = lists[list]; i < lists[list + 1]; ++i) {
        uint2 range = ranges[i];
        for (uint cluster = range.x; cluster < range.x + range.y; ++cluster) {
            if (below_horizon(r, boxes[cluster])) continue;
            uint first = cluster * BLOCKER_CLUSTER;
            for (uint t = first; t < first + BLOCKER_CLUSTER; t += CLGI_WIDTH) {
                uint index[CLGI_WIDTH];
                for (int k = 0; k < CLGI_WIDTH; ++k) index[k] = t + k;
                draw_packet(r, corners + t, params.blocker_stride, 0, index, packet, heights,
                            &nearest);
            }
        }
    }
#ifdef CLGI_NEAR
    uint end = near_lists[receiver + 1];
    for (uint i = near_lists[receiver]; i < end; i += CLGI_WIDTH) {
        uint index[CLGI_WIDTH];
        for (int k = 0; k < CLGI_WIDTH; ++k) index[k] = near_ones[min(i + k, end - 1)];
        draw_packet(r, corners, params.blocker_stride, index, index, packet, heights, &nearest);
    }
#endif
    for (int row = 0; row < CLGI_MASK; ++row) {
        uint triangle[CLGI_WIDTH];
        packet_store(nearest.triangle[row], triangle);
        for (int k = 0; k < CLGI_WIDTH; ++k) {
            if (triangle[k] == NO_TRIANGLE || (k > 0 && triangle[k] == triangle[k - 1])) continue;
            atomic_or(seen + triangle[k] / 32 * params.receiver_stride + receiver,
                      1u << (triangle[k] % 32));
        }
    }
}
