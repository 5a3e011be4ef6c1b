// The directions in which triangles block the view of receivers.
//
//   mask = OR over triangles of (AND over their edges of the half-space inside the edge)
//                                                                 [Kautz04, section 3.1.1]
//
// A packet of triangles is brought into the receiver's frame. Triangles below the horizon, and those
// whose box on the disc has no pixel's centre, end there. The others are drawn one after the other:
// the planes of their edges are evaluated at every pixel of the box. With CLGI_TABLE three masks of
// the table of planes are combined instead, as in the paper.
//
// With CLGI_NEAR every receiver has a list of single triangles besides: those near it, where a coarse
// mesh stands for the rest [Kautz04, section 3.2]. The corners of a packet are gathered; the last
// packet of a list repeats its last triangle, which changes nothing.
//
// Differences from the paper: planes are exact without CLGI_TABLE; no triangle is clipped
// (transfer/cone.clh); triangles are seen from both sides.
//
// Cost         some 150 operations a packet of triangles, and 10 for each row of 1 packet of columns
//              in the box of a triangle that is drawn; 36 bytes a triangle, read from cache. With
//              the table 3 x 4 bytes a column instead, whatever the box. A single triangle takes
//              9 loads of 4 bytes more.
// Work size    1D, one work-item a receiver; any local size; tail guarded
// Writes       its own mask
// SPDX-License-Identifier: MIT
#include "transfer/lanes.clh"

typedef struct {
    uintp word[ROW_WORDS * COLUMN_PACKETS];
} Mask;

#ifdef CLGI_TABLE
// Rows first to last of a word.
CLGI_INLINE uint row_bits(int first, int last, int word) {
    int low = max(first - 32 * word, 0), high = min(last - 32 * word, 31);
    return low > high ? 0u : (0xffffffffu << low) & (0xffffffffu >> (31 - high));
}

// The planes of a narrow triangle are rounded apart, and meet far from it: beyond a pixel around its
// box nothing is drawn.                               [derived: planes turn by atan(sqrt(2) / Q) at most]
CLGI_INLINE void draw(const Lanes* lanes, int k, global const uint* restrict table, Mask* mask) {
    int first_column = lanes->first_column[k] - 1, last_column = lanes->last_column[k] + 1;
    int first_packet = max(first_column, 0) / CLGI_WIDTH;
    int last_packet = min(last_column, CLGI_MASK - 1) / CLGI_WIDTH;
    for (int word = 0; word < ROW_WORDS; ++word) {
        uint rows = row_bits(lanes->first_row[k] - 1, lanes->last_row[k] + 1, word);
        for (int packet = first_packet; packet <= last_packet; ++packet) {
            intp column = packet_lanes + packet * CLGI_WIDTH;
            uintp inside = packet_select((uintp)(0), (uintp)(rows),
                                         (column >= first_column) & (column <= last_column));
            for (int e = 0; e < 3; ++e) {
                uint at = ((uint)lanes->entry[e][k] * ROW_WORDS + word) * MASK_COLUMNS(CLGI_MASK) +
                          packet * CLGI_WIDTH;
                inside &= packet_load(table + at) ^ (uintp)(lanes->complement[e][k]);
            }
            mask->word[word * COLUMN_PACKETS + packet] |= inside;
        }
    }
}
#else
CLGI_INLINE void draw(const Lanes* lanes, int k, global const float* restrict heights,
                      Mask* mask) {
    int first_row = lanes->first_row[k], last_row = lanes->last_row[k];
    int first_packet = lanes->first_column[k] / CLGI_WIDTH;
    int last_packet = lanes->last_column[k] / CLGI_WIDTH;
    Edges edges = lane_edges(lanes, k);
    for (int packet = first_packet; packet <= last_packet; ++packet) {
        floatp x = column_x(packet);
        floatp along[3];
        for (int e = 0; e < 3; ++e) along[e] = packet_splat(edges.x[e]) * x;
        for (int word = first_row / 32; word <= last_row / 32; ++word) {
            int at = word * COLUMN_PACKETS + packet;
            uintp bits = mask->word[at];
            int last = min(last_row, 32 * word + 31);
            for (int row = max(first_row, 32 * word); row <= last; ++row) {
                floatp z = packet_load(heights + row * MASK_COLUMNS(CLGI_MASK) +
                                       packet * CLGI_WIDTH);
                intp inside = inside_edges(edges, along, packet_splat(row_y(row)), z);
                bits |= packet_select((uintp)(0), (uintp)(1u << (row & 31)), inside);
            }
            mask->word[at] = bits;
        }
    }
}
#endif

#ifdef CLGI_TABLE
typedef global const uint* Drawn;  // the table of planes
#else
typedef global const float* Drawn;  // [CLGI_MASK][MASK_COLUMNS] z of pixels
#endif

typedef struct {
    Mask mask;
    Drawn drawn;
    uint table_size;
} Target;

CLGI_INLINE void draw_packet(Receiver r, global const float* corners, uint stride,
                             const uint* triangle, uint first, Target* target) {
    Cones cones;
    if (!make_cones(r, corners, stride, triangle, &cones)) return;
    Lanes lanes;
    to_lanes(&cones, target->table_size, &lanes);
    for (int k = 0; k < CLGI_WIDTH; ++k)
        if (lanes.alive[k]) draw(&lanes, k, target->drawn, &target->mask);
}

#include "transfer/lists.clh"

kernel void transfer_mask(
    const MaskParams         params,
    global const float*      restrict receivers,  // [RECEIVER_PLANES][receiver_stride]
    BLOCKER_ARGUMENTS,
    Drawn                    restrict drawn,
    global uint*             restrict masks)      // [MASK_WORDS][receiver_stride]
{
    uint receiver = (uint)get_global_id(0);
    if (receiver >= params.receiver_count) return;
    Receiver r = load_receiver(receivers, params.receiver_stride, receiver);
    Target target;
    for (int i = 0; i < ROW_WORDS * COLUMN_PACKETS; ++i) target.mask.word[i] = (uintp)(0);
    target.drawn = drawn;
    target.table_size = params.table_size;
    BlockerLists from = BLOCKER_LISTS;
    draw_listed(r, receiver, params, from, &target);
    for (int word = 0; word < ROW_WORDS; ++word)
        for (int packet = 0; packet < COLUMN_PACKETS; ++packet) {
            uint bits[CLGI_WIDTH];
            packet_store(target.mask.word[word * COLUMN_PACKETS + packet] & disc_word(word, packet),
                         bits);
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                uint at = (uint)(word * MASK_COLUMNS(CLGI_MASK) + packet * CLGI_WIDTH + k);
                masks[at * params.receiver_stride + receiver] = bits[k];
            }
        }
}
