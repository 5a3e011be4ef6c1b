// Which texels of blocks the VPLs of a batch see: the second of two steps, after see_listed.cl.
//
//   a VPL sees all corners of a flat block, or none    every texel of the block has their bit
//   it sees some of them, or the block is not flat     every texel looks it up
//
// [Schaerfig16, section 6.2: low resolution first, in full at discontinuities]
//
// Deviation     the paper interpolates light. Here bits alone are taken from the corners: form
//               factors stay those of each texel. What is narrower than the distance of corners, and
//               reaches none of them, is missed.
//
// Work size     1D, BLOCK_TEXELS / CLGI_WIDTH work-items for every block; any local size; tail
//               guarded
// Writes        the bytes of its own texels, one for every SEEN_VPLS shooters
// Cost          corners + 4 loads for a packet and a row of bits; for a VPL that is looked up, as
//               see.clh
// SPDX-License-Identifier: MIT
#include "atlas/see.clh"

#define BLOCK_PARTS (BLOCK_TEXELS / CLGI_WIDTH)  // work-items of a block

// A packet lies in so many rows of its block.
#if CLGI_WIDTH == 1
#define block_load(plane, row, column) (plane)[(row)[0] + (column)]
#elif CLGI_WIDTH == 4
#define block_load(plane, row, column) vload4(0, (plane) + (row)[0])
#elif CLGI_WIDTH == 8
#define block_load(plane, row, column) \
    (floatp)(vload4(0, (plane) + (row)[0]), vload4(0, (plane) + (row)[1]))
#else
#define block_load(plane, row, column)                                        \
    (floatp)(vload4(0, (plane) + (row)[0]), vload4(0, (plane) + (row)[1]),     \
             vload4(0, (plane) + (row)[2]), vload4(0, (plane) + (row)[3]))
#endif

CLGI_INLINE void block_store(intp bits, global uchar* seen, const uint* row, uint column) {
#if CLGI_WIDTH == 1
    seen[row[0] + column] = (uchar)bits;
#elif CLGI_WIDTH == 4
    vstore4(convert_uchar4(bits), 0, seen + row[0]);
#elif CLGI_WIDTH == 8
    uchar8 bytes = convert_uchar8(bits);
    vstore4(bytes.lo, 0, seen + row[0]);
    vstore4(bytes.hi, 0, seen + row[1]);
#else
    uchar16 bytes = convert_uchar16(bits);
    vstore4(bytes.s0123, 0, seen + row[0]);
    vstore4(bytes.s4567, 0, seen + row[1]);
    vstore4(bytes.s89ab, 0, seen + row[2]);
    vstore4(bytes.scdef, 0, seen + row[3]);
#endif
}

kernel void atlas_see_blocks(
    const BlockParams        params,
    global const View*       restrict views,        // [5 * shooter_count]
    global const uint*       restrict depth,        // [pixels of the views]
    global const float*      restrict texels,       // [>= GBUFFER_GEOMETRIC + 3][stride]
    global const AtlasBlock* restrict blocks,       // [block_count]
    global const uchar*      restrict listed_seen,  // [rows of the batch][listed_stride]
    global uchar*            restrict seen)         // [rows][stride]
{
    uint id = (uint)get_global_id(0);
    if (id / BLOCK_PARTS >= params.block_count) return;
    global const AtlasBlock* block = blocks + id / BLOCK_PARTS;
    uint lane = id % BLOCK_PARTS * CLGI_WIDTH, column = lane % 4;
    uint row[(CLGI_WIDTH + 3) / 4];
    for (uint k = 0; k < (CLGI_WIDTH + 3) / 4; ++k) row[k] = block->row[lane / 4 + k];
    uint stride = params.stride;
    global uchar* to = seen + (ulong)params.first_row * stride;
    for (uint first = 0; first < params.shooter_count; first += SEEN_VPLS) {
        int all = SEE_ALL, some = 0;
        for (uint k = 0; k < block->corners; ++k) {
            int corner = listed_seen[block->corner[k]];
            all &= corner;
            some |= corner;
        }
        int asked = block->flat ? some & ~all : SEE_ALL;
        intp bits = (intp)(all & ~asked);
        if (asked) {
            uint last = min(first + SEEN_VPLS, params.shooter_count);
            global const float* from = texels;
            floatp px = block_load(from, row, column);
            floatp py = block_load(from + stride, row, column);
            floatp pz = block_load(from + 2 * stride, row, column);
            from += GBUFFER_GEOMETRIC * stride;
            floatp gx = block_load(from, row, column);
            floatp gy = block_load(from + stride, row, column);
            floatp gz = block_load(from + 2 * stride, row, column);
            bits |= see_bits(views, depth, first, last, asked, px, py, pz, gx, gy, gz);
        }
        block_store(bits, to, row, column);
        listed_seen += params.listed_stride;
        to += stride;
    }
}
