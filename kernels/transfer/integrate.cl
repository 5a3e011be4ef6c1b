// Transfer vectors from masks: what of the light from everywhere arrives, cosine included.
//
//   V*_i = sum over cells of (1 - blocked / pixels) c_i                [Kautz04, Eq. 3, section 3.2]
//
// in the world's frame, with the weights z of clgi/mask_weights.hpp: first the sums of z over the
// cells, then Y_lm(R d_j) times their sums.
//
// With CLGI_GLOSS it is the transfer vector of the Phong lobe (docs/materials.md) instead:
//
//   sum over cells of (1 - blocked / pixels) c_i (n + 2) / (2 pi) max(0, s . r)^n
//
// s: mean direction of the cell, r: mirrored direction to the eye. Lobes narrower than a cell are
// widened to it, with their integral: n is at most 2 / w^2, w: width of a cell in the disc.
//                                                      [derived: docs/materials.md, Kautz04, Eq. 3]
//
// With CLGI_OPEN as well nothing blocks: no masks are read, and the result is that of empty ones.
//
// Cost         (R / B)^2 (terms + 6) multiply-adds for CLGI_WIDTH receivers, where a cell is blocked
//              in any of them, and 2 (2 bands - 1) terms for the turn; R^2 / 8 bytes a receiver
// Work size    1D, one work-item a packet of receivers; any local size; tail guarded
// Writes       the vectors of its receivers; NaN for a lobe whose exponent is NaN, and where the eye
//              is at the receiver, or too far for a float; 0 where the frame is (transfer/pixels.cl)
// SPDX-License-Identifier: MIT
#include "transfer/disc.clh"
#include "transfer/sh.clh"

#ifndef CLGI_BLOCK
#define CLGI_BLOCK 2  // B, pixels, width of a cell: 1, 2, 4 or 8
#endif

enum { CELL_SIDE = CLGI_MASK / CLGI_BLOCK, DIRECTIONS = 2 * CLGI_SH_BANDS - 1 };

// Cells are counted in fields of a word, twice as wide as the cell: those with even and those with
// odd rows of cells.
#if CLGI_BLOCK == 1
enum { COUNTS = 1, FIELD = 1 };
#else
enum { COUNTS = 2, FIELD = 2 * CLGI_BLOCK };
#endif

#define FIELD_MASK (CLGI_BLOCK == 1 ? 1u : (1u << FIELD) - 1u)

// The bits of each CLGI_BLOCK rows of a column, as numbers.
CLGI_INLINE uintp count_rows(uintp v) {
#if CLGI_BLOCK >= 2
    v = v - ((v >> 1) & 0x55555555u);
#endif
#if CLGI_BLOCK >= 4
    v = (v & 0x33333333u) + ((v >> 2) & 0x33333333u);
#endif
#if CLGI_BLOCK >= 8
    v = (v + (v >> 4)) & 0x0f0f0f0fu;
#endif
    return v;
}

// Adds the fields of a column to those of the cells.
CLGI_INLINE void add_column(uintp v, uintp* counts) {
#if CLGI_BLOCK == 1
    counts[0] = v;
#elif CLGI_BLOCK == 2
    counts[0] += v & 0x33333333u;
    counts[1] += (v >> 2) & 0x33333333u;
#elif CLGI_BLOCK == 4
    counts[0] += v & 0x0f0f0f0fu;
    counts[1] += (v >> 4) & 0x0f0f0f0fu;
#else
    counts[0] += v & 0x00ff00ffu;
    counts[1] += (v >> 8) & 0x00ff00ffu;
#endif
}

CLGI_INLINE void load_axis(global const float* planes, uint stride, floatp* axis) {
    packet_load3(planes, stride, axis, axis + 1, axis + 2);
}

CLGI_INLINE floatp dot_axis(const floatp* a, const floatp* b) {
    return packet_dot(a[0], a[1], a[2], b[0], b[1], b[2]);
}

kernel void transfer_integrate(
    const IntegrateParams  params,
    global const float*    restrict receivers,   // [RECEIVER_PLANES][stride]
#ifndef CLGI_OPEN
    global const uint*     restrict masks,       // [MASK_WORDS][stride]
#endif
    global const float*    restrict weights,     // [cells + 1][terms] MaskWeights::values
    global const float4*   restrict directions,  // [DIRECTIONS + cells] MaskWeights::directions
#ifdef CLGI_GLOSS
    global const float*    restrict exponents,   // [stride] of the receivers' lobes
#endif
    global float*          restrict transfer)    // [terms][stride] sr
{
    uint first = (uint)get_global_id(0) * CLGI_WIDTH;
    if (first >= params.receiver_count) return;
    uint stride = params.stride;
    global const float* planes = receivers + first;
    floatp tangent[3], bitangent[3], normal[3];
    load_axis(planes + RECEIVER_TANGENT * stride, stride, tangent);
    load_axis(planes + RECEIVER_BITANGENT * stride, stride, bitangent);
    load_axis(planes + RECEIVER_NORMAL * stride, stride, normal);

    floatp sum[SH_TERMS];
#ifdef CLGI_GLOSS
    floatp eye[3], mirrored[3];
    load_axis(planes + RECEIVER_POSITION * stride, stride, eye);
    // A direction is the same everywhere.
    if (params.eye.w != 0.0f) eye[0] = eye[1] = eye[2] = packet_zero;
    eye[0] = packet_splat(params.eye.x) - eye[0];
    eye[1] = packet_splat(params.eye.y) - eye[1];
    eye[2] = packet_splat(params.eye.z) - eye[2];
    // Where no surface is, the frame is zero: no light is lost there, wherever the eye is.
    uintp frame = packet_magnitude(normal[0]) | packet_magnitude(normal[1]) |
                  packet_magnitude(normal[2]);
    floatp distance = packet_select(sqrt(dot_axis(eye, eye)), packet_splat(1.0f),
                                    as_intp(frame) == (intp)(0));
    // In the receiver's frame the mirror is a change of sign.
    mirrored[0] = -dot_axis(tangent, eye) / distance;
    mirrored[1] = -dot_axis(bitangent, eye) / distance;
    mirrored[2] = dot_axis(normal, eye) / distance;
    floatp widest = packet_splat(0.5f * CELL_SIDE * CELL_SIDE);
    floatp asked = packet_load(exponents + first);
    floatp exponent = packet_min(asked, widest);
    // Without a direction or an exponent there is no lobe, which is not darkness. By bits, since
    // fast math takes every number for finite.
    intp far = as_intp(packet_magnitude(distance));
    intp lost = (far == (intp)(0)) | (far >= (intp)(NOT_FINITE)) |
                (as_intp(packet_magnitude(asked)) > (intp)(NOT_FINITE));
    floatp norm = (exponent + packet_splat(2.0f)) * packet_splat(0.5f / CLGI_PI);
    for (int i = 0; i < SH_TERMS; ++i) sum[i] = packet_zero;
#else
    global const float* all = weights + CELL_SIDE * CELL_SIDE * SH_TERMS;
    for (int i = 0; i < SH_TERMS; ++i) sum[i] = packet_splat(all[i]);
#endif

    for (int column = 0; column < CELL_SIDE; ++column)
        for (int word = 0; word < ROW_WORDS; ++word) {
            uintp counts[COUNTS];
            for (int k = 0; k < COUNTS; ++k) counts[k] = (uintp)(0);
#ifndef CLGI_OPEN
            for (int k = 0; k < CLGI_BLOCK; ++k) {
                uint at = (uint)(word * MASK_COLUMNS(CLGI_MASK) + column * CLGI_BLOCK + k);
                add_column(count_rows(packet_load(masks + at * stride + first)), counts);
            }
#endif
#ifndef CLGI_GLOSS
            uintp any = counts[0];
            if (COUNTS > 1) any |= counts[COUNTS - 1];
            if (!packet_any(any != 0u)) continue;
#endif
            int rows = min(32, CLGI_MASK) / CLGI_BLOCK;
            for (int row = 0; row < rows; ++row) {
                uintp count = (counts[row % COUNTS] >> (uint)(row / COUNTS * FIELD)) & FIELD_MASK;
                uint cell = (uint)(column * CELL_SIDE + word * rows + row);
#ifdef CLGI_GLOSS
                float4 s = directions[DIRECTIONS + cell];
                if (s.w == 0.0f) continue;
                floatp along = fma(packet_splat(s.x), mirrored[0],
                                   fma(packet_splat(s.y), mirrored[1], mirrored[2] * s.z));
                floatp open = packet_splat(s.w) - packet_float(count);
                // The smallest cosine keeps a lobe of exponent 0 at 1 in front alone.
                floatp lobe = exp2(exponent * log2(packet_max(along, packet_splat(1e-30f))));
                floatp share = packet_select(packet_zero, open * norm * lobe, along > packet_zero);
#else
                if (!packet_any(count != 0u)) continue;
                floatp share = -packet_float(count);
#endif
                global const float* weight = weights + cell * SH_TERMS;
                for (int i = 0; i < SH_TERMS; ++i)
                    sum[i] = fma(share, packet_splat(weight[i]), sum[i]);
            }
        }

    floatp out[SH_TERMS];
    for (int i = 0; i < SH_TERMS; ++i) out[i] = packet_zero;
    for (int j = 0; j < DIRECTIONS; ++j) {
        float4 d = directions[j];
        floatp axis[3], y[SH_TERMS];
        for (int k = 0; k < 3; ++k)
            axis[k] = fma(packet_splat(d.x), tangent[k],
                          fma(packet_splat(d.y), bitangent[k], normal[k] * d.z));
        sh_evaluate(axis[0], axis[1], axis[2], y);
        for (int l = (j + 1) / 2; l < CLGI_SH_BANDS; ++l)
            for (int m = 0; m < 2 * l + 1; ++m)
                out[l * l + m] = fma(sum[l * l + j], y[l * l + m], out[l * l + m]);
    }
    for (int i = 0; i < SH_TERMS; ++i) {
#ifdef CLGI_GLOSS
        out[i] = packet_select(out[i], packet_splat(as_float(0x7fc00000)), lost);
#endif
        packet_store(out[i], transfer + i * stride + first);
    }
}
