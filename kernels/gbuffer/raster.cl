// Draws triangles into a visibility buffer: small ones at once, the others set up for raster_large.
//
//   E(x, y) = (qx - px)(y - py) - (qy - py)(x - px) >= 0 for the three edges p -> q
//
// in integers, with the top-left rule for E = 0, so that a shared edge covers each pixel exactly
// once. Most triangles of a dense mesh face away or miss every pixel centre: a packet of them is
// sorted out at once, and only what is left is drawn one by one.
// [derived: fixed-point edge functions, after Pineda, A Parallel Algorithm for Polygon Rasterization]
//
// Work size    1D, one work-item for every CLGI_WIDTH triangles (rounded up); any local size
// Writes       visibility by integer minimum (no order), polygons (any order; all are drawn)
#include "gbuffer/polygon.clh"
#include "gbuffer/visibility.clh"
#include "packet.clh"

// Corners further apart than this leave 32-bit edge functions.
#define SMALL_SUBPIXELS 8192

// The pixels that a packet's lanes stand for.
#if CLGI_WIDTH == 1
#define BLOCK_WIDTH 1
#elif CLGI_WIDTH == 4
#define BLOCK_WIDTH 2
#else
#define BLOCK_WIDTH 4
#endif
#define BLOCK_HEIGHT (CLGI_WIDTH / BLOCK_WIDTH)

typedef struct {
    int left, right, top, bottom;
} PixelBox;

// All coordinates relative to the first corner fit 32 bits.
static void draw_small(const View* view, uint stage, ScreenVertex v0, ScreenVertex v1,
                       ScreenVertex v2, PixelBox box, uint triangle,
                       volatile global ulong* visibility) {
    int bx = v1.x - v0.x, by = v1.y - v0.y;
    int cx = v2.x - v0.x, cy = v2.y - v0.y;
    float b_closer = v1.closeness - v0.closeness;
    float c_closer = v2.closeness - v0.closeness;
    int area = bx * cy - cx * by;
    if (area < 0) {
        int swap = bx;
        bx = cx;
        cx = swap;
        swap = by;
        by = cy;
        cy = swap;
        float swap_closer = b_closer;
        b_closer = c_closer;
        c_closer = swap_closer;
        area = -area;
    }
    // Edges 0 -> b, b -> c, c -> 0; an edge owns its pixels when it is top or left.
    int dx0 = bx, dy0 = by, dx1 = cx - bx, dy1 = cy - by, dx2 = -cx, dy2 = -cy;
    int own0 = dy0 < 0 || (dy0 == 0 && dx0 > 0) ? 0 : -1;
    int own1 = dy1 < 0 || (dy1 == 0 && dx1 > 0) ? 0 : -1;
    int own2 = dy2 < 0 || (dy2 == 0 && dx2 > 0) ? 0 : -1;
    int x = box.left * SUBPIXELS + SUBPIXELS / 2 - v0.x;
    int y = box.top * SUBPIXELS + SUBPIXELS / 2 - v0.y;
    int row0 = dx0 * y - dy0 * x + own0;
    int row1 = dx1 * (y - by) - dy1 * (x - bx) + own1;
    int row2 = dx2 * y - dy2 * x + own2;
    float per_area = 1.0f / (float)area;
    float slope_x = (b_closer * (float)cy - c_closer * (float)by) * per_area;
    float slope_y = (c_closer * (float)bx - b_closer * (float)cx) * per_area;
    float closest = max(v0.closeness, max(v1.closeness, v2.closeness));
    float farthest = min(v0.closeness, min(v1.closeness, v2.closeness));

    // A block of pixels at a time: its lanes, the edges over them, and those that are covered.
    intp lane_x = packet_lanes & (BLOCK_WIDTH - 1);
    intp lane_y = packet_lanes / BLOCK_WIDTH;
    intp ahead0 = (lane_y * dx0 - lane_x * dy0) * SUBPIXELS;
    intp ahead1 = (lane_y * dx1 - lane_x * dy1) * SUBPIXELS;
    intp ahead2 = (lane_y * dx2 - lane_x * dy2) * SUBPIXELS;
    for (int py = box.top; py <= box.bottom; py += BLOCK_HEIGHT) {
        for (int px = box.left; px <= box.right; px += BLOCK_WIDTH) {
            int right = (px - box.left) * SUBPIXELS;
            int down = (py - box.top) * SUBPIXELS;
            intp e0 = row0 + down * dx0 - right * dy0 + ahead0;
            intp e1 = row1 + down * dx1 - right * dy1 + ahead1;
            intp e2 = row2 + down * dx2 - right * dy2 + ahead2;
            intp covered = ((e0 | e1 | e2) >= 0) & (lane_x <= box.right - px) &
                           (lane_y <= box.bottom - py);
            if (!packet_any(covered)) continue;
            // The same sum for a pixel wherever its block begins.
            floatp closeness = v0.closeness +
                               (packet_float(x + right + lane_x * SUBPIXELS) * slope_x +
                                packet_float(y + down + lane_y * SUBPIXELS) * slope_y);
            closeness = packet_min(packet_max(closeness, packet_splat(farthest)),
                                   packet_splat(closest));
            int lane_covered[CLGI_WIDTH];
            float lane_closeness[CLGI_WIDTH];
            packet_store(covered, lane_covered);
            packet_store(closeness, lane_closeness);
            int lanes[CLGI_WIDTH + 1];
            int count = 0;
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                lanes[count] = k;
                count += lane_covered[k] != 0;
            }
            for (int n = 0; n < count; ++n) {
                int k = lanes[n];
                uint row = (uint)(py + k / BLOCK_WIDTH) * view->width;
                uint pixel = view->first_pixel + row + (uint)(px + (k & (BLOCK_WIDTH - 1)));
                visibility_put(visibility + pixel, lane_closeness[k], triangle, stage);
            }
        }
    }
}

kernel void gbuffer_raster(
    const View                   view,
    const RasterParams           params,
    global const uint4*          restrict triangles,      // [triangle_count]
    global const ScreenVertex*   restrict vertices,       // [vertex_count] from gbuffer_transform
    global const float4*         restrict positions,      // [vertex_count] local frame
    volatile global ulong*       restrict visibility,     // [pixels of all views]
    global RasterPolygon*        restrict polygons,       // [triangle_count]
    volatile global uint*        restrict polygon_count)  // [1]
{
    uint first = (uint)get_global_id(0) * CLGI_WIDTH;
    if (first >= params.triangle_count) return;

    uint4 corner[CLGI_WIDTH];
    int4 row[3][CLGI_WIDTH];  // ScreenVertex as four words
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        corner[k] = triangles[min(first + k, params.triangle_count - 1)];
        row[0][k] = vload4(corner[k].x, (global const int*)vertices);
        row[1][k] = vload4(corner[k].y, (global const int*)vertices);
        row[2][k] = vload4(corner[k].z, (global const int*)vertices);
    }

    // Pixels whose centres the bounding box contains.
    intp x0 = (intp)(packet_collect(row[0], x)), y0 = (intp)(packet_collect(row[0], y));
    intp x1 = (intp)(packet_collect(row[1], x)), y1 = (intp)(packet_collect(row[1], y));
    intp x2 = (intp)(packet_collect(row[2], x)), y2 = (intp)(packet_collect(row[2], y));
    intp outside = (intp)(packet_collect(row[0], w)) | (intp)(packet_collect(row[1], w)) |
                   (intp)(packet_collect(row[2], w));
    intp word = as_intp((uintp)(packet_collect(corner, w)));
    intp low_x = min(x0, min(x1, x2)), high_x = max(x0, max(x1, x2));
    intp low_y = min(y0, min(y1, y2)), high_y = max(y0, max(y1, y2));
    intp left = max((low_x + SUBPIXELS / 2 - 1) >> 8, 0);
    intp right = min((high_x - SUBPIXELS / 2) >> 8, (int)view.width - 1);
    intp top = max((low_y + SUBPIXELS / 2 - 1) >> 8, 0);
    intp bottom = min((high_y - SUBPIXELS / 2) >> 8, (int)view.height - 1);
    intp is_outside = outside != 0;
    intp compact = (high_x - low_x < SMALL_SUBPIXELS) & (high_y - low_y < SMALL_SUBPIXELS);
    // Exact where the triangle is compact; others are judged when they are set up. Front faces
    // have negative area here, since y points down.
    intp area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
    intp hidden = area == 0;
    if (view.flags & VIEW_CULL_BACK_FACES)
        hidden |= (area > 0) & ((word & TRIANGLE_DOUBLE_SIDED) == 0);
    intp small = compact & (right - left < (int)params.small_size) &
                 (bottom - top < (int)params.small_size) & ((word & TRIANGLE_MASKED) == 0);
    intp wanted = is_outside | ((left <= right) & (top <= bottom) & ((compact == 0) | (hidden == 0)));

    int lane_wanted[CLGI_WIDTH];
    int lane_small[CLGI_WIDTH];
    int boxes[4][CLGI_WIDTH];
    packet_store(wanted, lane_wanted);
    packet_store(small & (is_outside == 0), lane_small);
    packet_store(left, boxes[0]);
    packet_store(right, boxes[1]);
    packet_store(top, boxes[2]);
    packet_store(bottom, boxes[3]);
    int lanes[CLGI_WIDTH];
    int count = 0;
    int last = (int)min((uint)CLGI_WIDTH, params.triangle_count - first);
    for (int k = 0; k < last; ++k) {
        lanes[count] = k;
        count += lane_wanted[k] != 0;
    }

    for (int n = 0; n < count; ++n) {
        int k = lanes[n];
        uint triangle = first + (uint)k;
        uint4 corners = corner[k];
        ScreenVertex v0 = vertices[corners.x];
        ScreenVertex v1 = vertices[corners.y];
        ScreenVertex v2 = vertices[corners.z];
        if (lane_small[k]) {
            PixelBox box = {boxes[0][k], boxes[1][k], boxes[2][k], boxes[3][k]};
            draw_small(&view, params.stage, v0, v1, v2, box, triangle, visibility);
            continue;
        }
        if (params.stage == RASTER_IDENTITY) continue;  // listed in the stage before
        int2 pixels[8];
        float closeness[8];
        int corner_count = 3;
        if (v0.outside | v1.outside | v2.outside) {
            if (v0.outside & v1.outside & v2.outside & VERTEX_BEFORE_NEAR) continue;
            float3 cut[9] = {gbuffer_to_view(&view, positions[corners.x]),
                             gbuffer_to_view(&view, positions[corners.y]),
                             gbuffer_to_view(&view, positions[corners.z])};
            corner_count = polygon_clip_to_view(&view, cut);
            if (corner_count < 3) continue;
            for (int i = 0; i < corner_count; ++i) {
                pixels[i] = gbuffer_to_subpixels(&view, gbuffer_to_window(&view, cut[i]));
                closeness[i] = gbuffer_closeness(&view, cut[i].z);
            }
        } else {
            pixels[0] = (int2)(v0.x, v0.y);
            pixels[1] = (int2)(v1.x, v1.y);
            pixels[2] = (int2)(v2.x, v2.y);
            closeness[0] = v0.closeness;
            closeness[1] = v1.closeness;
            closeness[2] = v2.closeness;
        }
        polygon_set_up(&view, pixels, closeness, corner_count, triangle, corners.w, polygons,
                       polygon_count);
    }
}
