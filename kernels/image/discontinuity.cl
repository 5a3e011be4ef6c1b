// The discontinuity buffer: which pixels the low-resolution illumination does not suit.
//
// A pixel is compared with the points that it would be interpolated from, weighted as they would
// be; where the weighted difference reaches the threshold the pixel is computed in full.
//                                                              [Cochran07, section 3.5]
//
// Work size    1D, one work-item for every CLGI_WIDTH low-resolution points of a row, rows padded
//              to whole packets; any local size
// Writes       flags of the pixels of its cells
#include "image/cell.clh"

static floatp difference(const CellPoint* pixel, const CellPoint* candidates, int count,
                         float position_scale) {
    floatp weights = packet_float(0 * packet_lanes);
    floatp sum = weights;
    for (int i = 0; i < count; ++i) {
        floatp d = cell_difference(pixel, candidates + i, position_scale);
        floatp weight = cell_weight(d);
        weights += weight;
        sum = fma(weight, d, sum);
    }
    return sum / weights;
}

static void put_flags(const Cell* cell, const RefineParams* params, uint right, uint down,
                      floatp value, global uchar* flags) {
    float lanes[CLGI_WIDTH];
    packet_store(value, lanes);
    uint y = 2 * cell->row + down;
    if (y >= params->height) return;
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        uint x = 2 * (cell->column + k) + right;
        if (cell->column + k < cell->low_width && x < params->width)
            flags[y * params->width + x] = lanes[k] >= params->threshold;
    }
}

kernel void image_discontinuity(
    const RefineParams   params,
    global const float*  restrict planes,  // [>= POINT_PLANES][stride]
    global const float*  restrict points,  // [POINT_PLANES][low_stride]
    global uchar*        restrict flags)   // [width * height] 1: compute in full
{
    Cell cell = cell_of_item(&params, (uint)get_global_id(0));
    if (cell.row >= cell.low_height) return;

    CellPoint low[4];
    low[0] = cell_low_point(&cell, &params, points, 0, 0);
    low[1] = cell_low_point(&cell, &params, points, 1, 0);
    low[2] = cell_low_point(&cell, &params, points, 0, 1);
    low[3] = cell_low_point(&cell, &params, points, 1, 1);
    float scale = params.position_scale;

    // Even column and row: the point itself.
    put_flags(&cell, &params, 0, 0, packet_float(0 * packet_lanes), flags);
    CellPoint pixel = cell_full_point(&cell, &params, planes, 1, 0);
    put_flags(&cell, &params, 1, 0, difference(&pixel, low, 2, scale), flags);
    pixel = cell_full_point(&cell, &params, planes, 0, 1);
    CellPoint column[2] = {low[0], low[2]};
    put_flags(&cell, &params, 0, 1, difference(&pixel, column, 2, scale), flags);
    pixel = cell_full_point(&cell, &params, planes, 1, 1);
    put_flags(&cell, &params, 1, 1, difference(&pixel, low, 4, scale), flags);
}
