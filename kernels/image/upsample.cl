// Brings low-resolution irradiance to every pixel, without bleeding across edges.
//
// Between two or four points, each weighs by how well it stands in for the pixel; on one plane
// that is plain bilinear interpolation.                        [Cochran07, section 3.5]
//
// Work size    1D, one work-item for every CLGI_WIDTH low-resolution points of a row, rows padded
//              to whole packets; any local size
// Writes       irradiance of the pixels of its cells
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

kernel void image_upsample(
    const RefineParams   params,
    global const float*  restrict planes,      // [>= POINT_PLANES][stride]
    global const float*  restrict points,      // [POINT_PLANES][low_stride]
    global const float*  restrict low,         // [params.planes][low_stride] irradiance
    global float*        restrict irradiance)  // [params.planes][stride]
{
    Cell cell = cell_of_item(&params, (uint)get_global_id(0));
    if (cell.row >= cell.low_height) return;

    CellPoint point[4];
    point[0] = cell_low_point(&cell, &params, points, 0, 0);
    point[1] = cell_low_point(&cell, &params, points, 1, 0);
    point[2] = cell_low_point(&cell, &params, points, 0, 1);
    point[3] = cell_low_point(&cell, &params, points, 1, 1);
    float scale = params.position_scale;

    // Weights: odd column of the even row, even column of the odd row, odd column of the odd row.
    CellPoint pixel = cell_full_point(&cell, &params, planes, 1, 0);
    floatp right0 = cell_weight(cell_difference(&pixel, point + 0, scale));
    floatp right1 = cell_weight(cell_difference(&pixel, point + 1, scale));
    floatp per_right = 1.0f / (right0 + right1);
    pixel = cell_full_point(&cell, &params, planes, 0, 1);
    floatp down0 = cell_weight(cell_difference(&pixel, point + 0, scale));
    floatp down2 = cell_weight(cell_difference(&pixel, point + 2, scale));
    floatp per_down = 1.0f / (down0 + down2);
    pixel = cell_full_point(&cell, &params, planes, 1, 1);
    floatp cross0 = cell_weight(cell_difference(&pixel, point + 0, scale));
    floatp cross1 = cell_weight(cell_difference(&pixel, point + 1, scale));
    floatp cross2 = cell_weight(cell_difference(&pixel, point + 2, scale));
    floatp cross3 = cell_weight(cell_difference(&pixel, point + 3, scale));
    floatp per_cross = 1.0f / (cross0 + cross1 + cross2 + cross3);

    for (uint plane = 0; plane < params.planes; ++plane) {
        global const float* source = low + plane * params.low_stride;
        global float* target = irradiance + plane * params.stride;
        floatp v0 = cell_low(&cell, source, 0, 0);
        floatp v1 = cell_low(&cell, source, 1, 0);
        floatp v2 = cell_low(&cell, source, 0, 1);
        floatp v3 = cell_low(&cell, source, 1, 1);
        put_row(&cell, &params, 0, v0, fma(right0, v0, right1 * v1) * per_right, target);
        put_row(&cell, &params, 1, fma(down0, v0, down2 * v2) * per_down,
                fma(cross0, v0, fma(cross1, v1, fma(cross2, v2, cross3 * v3))) * per_cross,
                target);
    }
}
