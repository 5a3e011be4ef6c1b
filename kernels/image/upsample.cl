// Brings low-resolution irradiance to every pixel without bleeding across edges, and marks the
// pixels that it does not suit: the discontinuity buffer.
//
//   weight_i   = bilinear_i / (0.01 + d_i)^2, divided by their sum    points i around pixel p
//   difference = sum weight_i (d_i + s^2 |q_i - p|^2);  the pixel is marked if >= threshold
//                                             [Cochran07, section 3.5; derived: d, image/cell.clh]
//
// d_i (cell_difference) says how badly point q_i represents the pixel, and s is position_scale. A
// point across an edge has next to no weight. The 0.01 bounds the weight of a point that fits
// exactly.
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up, by rows) of every
//              `step` rows; any local size
// Writes       irradiance and flags of its pixels
// Cost         170 flops and a division a pixel; 24 bytes are read and 13 written
// SPDX-License-Identifier: MIT
#include "image/cell.clh"

typedef struct {
    floatp weight[4];   // sum 1
    floatp difference;  // weighted mean
} Blend;

// right, down: where each pixel lies between its four points, [0,1).
static Blend blend(const CellPoint* pixel, const CellPoint* points, float position_scale,
                   floatp right, float down) {
    floatp difference[4];
    floatp base[4];
    #pragma unroll
    for (int i = 0; i < 4; ++i) {
        floatp apart;
        floatp d = cell_difference(pixel, points + i, position_scale, &apart);
        difference[i] = d + apart;
        base[i] = d + 0.01f;
    }
    // bilinear / base^2, all four times the product of base^2: one division instead of five.
    floatp upper = base[0] * base[1];
    floatp lower = base[2] * base[3];
    floatp left = 1.0f - right;
    floatp others[4] = {base[1] * lower, base[0] * lower, base[3] * upper, base[2] * upper};
    Blend out;
    out.weight[0] = left * (1.0f - down) * others[0] * others[0];
    out.weight[1] = right * (1.0f - down) * others[1] * others[1];
    out.weight[2] = left * down * others[2] * others[2];
    out.weight[3] = right * down * others[3] * others[3];
    floatp per_sum = 1.0f / ((out.weight[0] + out.weight[1]) + (out.weight[2] + out.weight[3]));
    floatp mean = packet_zero;
    #pragma unroll
    for (int i = 0; i < 4; ++i) {
        out.weight[i] *= per_sum;
        mean = fma(out.weight[i], difference[i], mean);
    }
    // Nothing is lit in full where nothing is.
    intp seen = packet_dot(pixel->nx, pixel->ny, pixel->nz, pixel->nx, pixel->ny, pixel->nz) > 0.0f;
    out.difference = packet_select(packet_zero, mean, seen);
    return out;
}

static void put_row(const Cell* cell, uint width, floatp lanes, Row row, uint begin) {
    if (cell->whole) {
        row_store(lanes, row, begin + cell->x);
        return;
    }
    float values[CLGI_WIDTH];
    packet_store(lanes, values);
    for (uint k = 0; cell->x + k < width; ++k) row_store_one(values[k], row, begin + cell->x + k);
}

static void put_flags(const Cell* cell, uint width, intp marked, global uchar* row) {
    if (cell->whole && width % 4 == 0) {
        packet_store_flags(marked & 1, row + cell->x);
        return;
    }
    int values[CLGI_WIDTH];
    packet_store(marked, values);
    uint count = min((uint)CLGI_WIDTH, width - cell->x);
    for (uint k = 0; k < count; ++k) row[cell->x + k] = values[k] != 0;
}

kernel void image_upsample(
    const RefineParams   params,
    global const float*  restrict planes,      // [>= POINT_PLANES][stride]
    global const float*  restrict points,      // [POINT_PLANES][low_stride]
    global const float*  restrict low,         // [IRRADIANCE_PLANES][low_stride] irradiance
    global float*        restrict irradiance,  // [IRRADIANCE_PLANES][stride]
    global uchar*        restrict flags)       // [width * height] 1: light in full
{
    uint step = params.step;
    Cell cell = cell_of_item(&params, (uint)get_global_id(0), step);
    if (cell.row >= cell.low_height) return;

    CellPoint point[4];
    cell_low_points(&cell, &params, step, points, 0, point, point + 1);
    cell_low_points(&cell, &params, step, points, 1, point + 2, point + 3);
    CellPair value[IRRADIANCE_PLANES][2];
    #pragma unroll
    for (uint plane = 0; plane < IRRADIANCE_PLANES; ++plane)
        for (uint down = 0; down < 2; ++down)
            value[plane][down] =
                cell_low(&cell, step, irradiance_row(low, plane, params.low_stride), down);

    intp phase = ((int)cell.x + packet_lanes) & (int)(step - 1);
    floatp right = packet_float(phase) * (1.0f / (float)step);
    uint last = min((cell.row + 1) * step, params.height);
    for (uint y = cell.row * step; y < last; ++y) {
        CellPoint pixel = cell_full_point(&cell, &params, planes, y);
        int first = y == cell.row * step;
        Blend between = blend(&pixel, point, params.position_scale, right,
                              (float)(y - cell.row * step) * (1.0f / (float)step));
        put_flags(&cell, params.width, between.difference >= params.threshold,
                  flags + y * params.width);
        #pragma unroll
        for (uint plane = 0; plane < IRRADIANCE_PLANES; ++plane) {
            const CellPair* v = value[plane];
            floatp mixed = fma(between.weight[0], v[0].left,
                               fma(between.weight[1], v[0].right,
                                   fma(between.weight[2], v[1].left,
                                       between.weight[3] * v[1].right)));
            // A low-resolution point has its own value, to the bit.
            if (first) mixed = packet_select(mixed, v[0].left, phase == 0);
            put_row(&cell, params.width, mixed,
                    irradiance_row(irradiance, plane, params.stride), y * params.width);
        }
    }
}
