// Brings low-resolution irradiance to every pixel without bleeding across edges, and marks the
// pixels that it does not suit: the discontinuity buffer.
//
// Between two or four points, each weighs by how well it stands in for the pixel; on one plane
// that is plain bilinear interpolation. Where the weighted mean of the differences reaches the
// threshold, the pixel is to be lit in full.                   [Cochran07, section 3.5]
//
// Work size    1D, one work-item for every CLGI_WIDTH low-resolution points of a row, rows padded
//              to whole packets; any local size
// Writes       irradiance and flags of the pixels of its cells
// SPDX-License-Identifier: MIT
#include "image/cell.clh"

static void put_row(const Cell* cell, const RefineParams* params, uint down, floatp even_lanes,
                    floatp odd_lanes, global float* plane) {
    uint y = 2 * cell->row + down;
    if (y >= params->height) return;
    global float* target = plane + y * params->width + 2 * cell->column;
    if (cell->whole) {
        packet_weave(even_lanes, odd_lanes, target);
        return;
    }
    float lanes[2][CLGI_WIDTH];
    packet_store(even_lanes, lanes[0]);
    packet_store(odd_lanes, lanes[1]);
    for (uint k = 0; k < 2 * CLGI_WIDTH && 2 * cell->column + k < params->width; ++k)
        target[k] = lanes[k & 1][k / 2];
}

static void put_flags(const Cell* cell, const RefineParams* params, uint down, floatp even_lanes,
                      floatp odd_lanes, global uchar* flags) {
    uint y = 2 * cell->row + down;
    if (y >= params->height) return;
    int lanes[2][CLGI_WIDTH];
    packet_store(even_lanes >= params->threshold, lanes[0]);
    packet_store(odd_lanes >= params->threshold, lanes[1]);
    global uchar* target = flags + y * params->width + 2 * cell->column;
    uint last = min(2u * CLGI_WIDTH, params->width - 2 * cell->column);
    for (uint k = 0; k < last; ++k) target[k] = lanes[k & 1][k / 2] != 0;
}

typedef struct {
    floatp weight[4];   // sum 1
    floatp difference;  // weighted mean
} Blend;

static Blend blend(const CellPoint* pixel, const CellPoint* points, int count,
                   float position_scale) {
    Blend out;
    floatp sum = packet_zero;
    floatp difference = packet_zero;
    for (int i = 0; i < count; ++i) {
        floatp d = cell_difference(pixel, points + i, position_scale);
        out.weight[i] = cell_weight(d);
        sum += out.weight[i];
        difference = fma(out.weight[i], d, difference);
    }
    floatp per_sum = 1.0f / sum;
    for (int i = 0; i < count; ++i) out.weight[i] *= per_sum;
    // Nothing is lit in full where nothing is.
    intp seen = packet_dot(pixel->nx, pixel->ny, pixel->nz, pixel->nx, pixel->ny, pixel->nz) > 0.0f;
    out.difference = packet_select(packet_zero, difference * per_sum, seen);
    return out;
}

kernel void image_upsample(
    const RefineParams   params,
    global const float*  restrict planes,      // [>= POINT_PLANES][stride]
    global const float*  restrict points,      // [POINT_PLANES][low_stride]
    global const float*  restrict low,         // [IRRADIANCE_PLANES][low_stride] irradiance
    global float*        restrict irradiance,  // [IRRADIANCE_PLANES][stride]
    global uchar*        restrict flags)       // [width * height] 1: light in full
{
    Cell cell = cell_of_item(&params, (uint)get_global_id(0));
    if (cell.row >= cell.low_height) return;

    CellPoint point[4];
    point[0] = cell_low_point(&cell, &params, points, 0, 0);
    point[1] = cell_low_point(&cell, &params, points, 1, 0);
    point[2] = cell_low_point(&cell, &params, points, 0, 1);
    point[3] = cell_low_point(&cell, &params, points, 1, 1);
    float scale = params.position_scale;

    CellPoint pixel = cell_full_point(&cell, &params, planes, 1, 0);
    Blend right = blend(&pixel, point, 2, scale);
    CellPoint column[2] = {point[0], point[2]};
    pixel = cell_full_point(&cell, &params, planes, 0, 1);
    Blend below = blend(&pixel, column, 2, scale);
    pixel = cell_full_point(&cell, &params, planes, 1, 1);
    Blend across = blend(&pixel, point, 4, scale);

    // An even column of an even row is its point itself.
    put_flags(&cell, &params, 0, packet_zero, right.difference, flags);
    put_flags(&cell, &params, 1, below.difference, across.difference, flags);

    for (uint plane = 0; plane < IRRADIANCE_PLANES; ++plane) {
        global const float* source = low + plane * params.low_stride;
        global float* target = irradiance + plane * params.stride;
        floatp v0 = cell_low(&cell, source, 0, 0);
        floatp v1 = cell_low(&cell, source, 1, 0);
        floatp v2 = cell_low(&cell, source, 0, 1);
        floatp v3 = cell_low(&cell, source, 1, 1);
        put_row(&cell, &params, 0, v0, fma(right.weight[0], v0, right.weight[1] * v1), target);
        put_row(&cell, &params, 1, fma(below.weight[0], v0, below.weight[1] * v2),
                fma(across.weight[0], v0,
                    fma(across.weight[1], v1,
                        fma(across.weight[2], v2, across.weight[3] * v3))),
                target);
    }
}
