// Draws triangles into a visibility buffer: small ones at once, the others set up for raster_large.
//
//   E(x, y) = (qx - px)(y - py) - (qy - py)(x - px) >= 0 for the three edges p -> q
//
// in integers, with the top-left rule for E = 0, so that a shared edge covers each pixel exactly
// once. Most triangles of a dense mesh face away or miss every pixel centre, and the rest cover a
// pixel or two. So packets of triangles are sorted out first; what is left is gathered and, where
// it is small, drawn a packet of triangles at a time, pixel by pixel of their boxes.
// [derived: fixed-point edge functions, after Pineda, A Parallel Algorithm for Polygon Rasterization]
//
// Work size    1D, one work-item for every RASTER_BATCH * CLGI_WIDTH triangles (rounded up); any
//              local size
// Writes       visibility by integer minimum (no order), runs of polygons (any order; all are drawn)
// SPDX-License-Identifier: MIT
#include "gbuffer/polygon.clh"
#include "gbuffer/visibility.clh"
#include "packet.clh"

// Corners further apart than this leave 32-bit edge functions.
#define SMALL_SUBPIXELS 8192

// CLGI_WIDTH triangles as the rasteriser meets them.
typedef struct {
    intp x0, y0, x1, y1, x2, y2;  // corners, 24.8
    intp left, right, top, bottom;  // pixels whose centres the bounding box contains
} TrianglePacket;

static TrianglePacket fetch_packet(const View* view, const uint4* corner,
                                   global const ScreenVertex* vertices, int4 row[3][CLGI_WIDTH]) {
    for (int k = 0; k < CLGI_WIDTH; ++k) {
        row[0][k] = vload4(corner[k].x, (global const int*)vertices);
        row[1][k] = vload4(corner[k].y, (global const int*)vertices);
        row[2][k] = vload4(corner[k].z, (global const int*)vertices);
    }
    TrianglePacket t;
    t.x0 = (intp)(packet_collect(row[0], x));
    t.y0 = (intp)(packet_collect(row[0], y));
    t.x1 = (intp)(packet_collect(row[1], x));
    t.y1 = (intp)(packet_collect(row[1], y));
    t.x2 = (intp)(packet_collect(row[2], x));
    t.y2 = (intp)(packet_collect(row[2], y));
    intp low_x = min(t.x0, min(t.x1, t.x2)), high_x = max(t.x0, max(t.x1, t.x2));
    intp low_y = min(t.y0, min(t.y1, t.y2)), high_y = max(t.y0, max(t.y1, t.y2));
    t.left = max((low_x + SUBPIXELS / 2 - 1) >> 8, (intp)(0));
    t.right = min((high_x - SUBPIXELS / 2) >> 8, (intp)((int)view->width - 1));
    t.top = max((low_y + SUBPIXELS / 2 - 1) >> 8, (intp)(0));
    t.bottom = min((high_y - SUBPIXELS / 2) >> 8, (intp)((int)view->height - 1));
    return t;
}

// -1 where an edge along (dx, dy) does not own the pixels that it passes through.
CLGI_INLINE intp edge_bias(intp dx, intp dy) {
    intp owned = (dy < 0) | ((dy == 0) & (dx > 0));
    return packet_select((intp)(-1), (intp)(0), owned);
}

// Draws a packet of small triangles: relative to a corner all their coordinates fit 32 bits. index: [CLGI_WIDTH] of each; lanes from `count` on repeat.
static void draw_small(const View* view, uint stage, const uint* index, int count,
                      global const uint4* triangles, global const ScreenVertex* vertices,
                      volatile global ulong* visibility) {
    uint4 corner[CLGI_WIDTH];
    int4 row[3][CLGI_WIDTH];
    for (int k = 0; k < CLGI_WIDTH; ++k) corner[k] = triangles[index[k]];
    TrianglePacket t = fetch_packet(view, corner, vertices, row);
    floatp near0 = packet_from_bits(as_uintp((intp)(packet_collect(row[0], z))));
    floatp near1 = packet_from_bits(as_uintp((intp)(packet_collect(row[1], z))));
    floatp near2 = packet_from_bits(as_uintp((intp)(packet_collect(row[2], z))));

    // Relative to the first corner, turned so that the area is positive.
    intp bx = t.x1 - t.x0, by = t.y1 - t.y0, cx = t.x2 - t.x0, cy = t.y2 - t.y0;
    intp area = bx * cy - cx * by;
    intp turned = area < 0;
    intp sx = packet_select(bx, cx, turned), sy = packet_select(by, cy, turned);
    cx = packet_select(cx, bx, turned);
    cy = packet_select(cy, by, turned);
    floatp closer_b = packet_select(near1, near2, turned) - near0;
    floatp closer_c = packet_select(near2, near1, turned) - near0;
    bx = sx;
    by = sy;
    intp x = t.left * SUBPIXELS + SUBPIXELS / 2 - t.x0;
    intp y = t.top * SUBPIXELS + SUBPIXELS / 2 - t.y0;
    intp dx1 = cx - bx, dy1 = cy - by;
    intp e0 = bx * y - by * x + edge_bias(bx, by);
    intp e1 = dx1 * (y - by) - dy1 * (x - bx) + edge_bias(dx1, dy1);
    intp e2 = cy * x - cx * y + edge_bias(-cx, -cy);
    floatp per_area = 1.0f / fabs(packet_float(area));
    floatp slope_x = (closer_b * packet_float(cy) - closer_c * packet_float(by)) * per_area;
    floatp slope_y = (closer_c * packet_float(bx) - closer_b * packet_float(cx)) * per_area;
    floatp closest = packet_max(near0, packet_max(near1, near2));
    floatp farthest = packet_min(near0, packet_min(near1, near2));

    intp wanted = packet_lanes < count;
    intp across = packet_select((intp)(-1), t.right - t.left, wanted);
    intp down = packet_select((intp)(-1), t.bottom - t.top, wanted);
    intp first_pixel = (int)view->first_pixel + t.top * (int)view->width + t.left;
    for (int v = 0; packet_any(down >= v); ++v) {
        for (int u = 0; packet_any(across >= u); ++u) {
            int us = u * SUBPIXELS;
            int vs = v * SUBPIXELS;
            intp inside = (e0 + vs * bx - us * by) | (e1 + vs * dx1 - us * dy1) |
                          (e2 - vs * cx + us * cy);
            intp covered = (inside >= 0) & (across >= u) & (down >= v);
            if (!packet_any(covered)) continue;
            floatp closeness = near0 + (packet_float(x + us) * slope_x +
                                        packet_float(y + vs) * slope_y);
            closeness = packet_min(packet_max(closeness, farthest), closest);
            int lane_covered[CLGI_WIDTH];
            int lane_pixel[CLGI_WIDTH];
            float lane_closeness[CLGI_WIDTH];
            packet_store(covered, lane_covered);
            packet_store(first_pixel + (v * (int)view->width + u), lane_pixel);
            packet_store(closeness, lane_closeness);
            int lanes[CLGI_WIDTH];
            int found = 0;
            for (int k = 0; k < CLGI_WIDTH; ++k) {
                lanes[found] = k;
                found += lane_covered[k] != 0;
            }
            for (int n = 0; n < found; ++n) {
                int k = lanes[n];
                visibility_put(visibility + lane_pixel[k], lane_closeness[k], index[k], stage);
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
    global RasterPolygon*        restrict polygons,    // [triangle_count]
    global RasterRun*            restrict runs,        // [triangle_count / RASTER_BATCH]
    volatile global uint*        restrict run_count)   // [1]
{
    uint first = (uint)get_global_id(0) * (RASTER_BATCH * CLGI_WIDTH);
    if (first >= params.triangle_count) return;
    uint last = min(first + RASTER_BATCH * CLGI_WIDTH, params.triangle_count);

    // Sort out: hidden ones go, small ones and the others come in a row each. Alpha is looked up by
    // raster_large, so masked triangles are never small.
    uint small[(RASTER_BATCH + 1) * CLGI_WIDTH];
    uint rest[RASTER_BATCH * CLGI_WIDTH + 1];
    int small_count = 0;
    int rest_count = 0;
    for (uint packet = first; packet < last; packet += CLGI_WIDTH) {
        uint4 corner[CLGI_WIDTH];
        int4 row[3][CLGI_WIDTH];
        for (uint k = 0; k < CLGI_WIDTH; ++k) corner[k] = triangles[min(packet + k, last - 1)];
        TrianglePacket t = fetch_packet(&view, corner, vertices, row);
        intp outside = (intp)(packet_collect(row[0], w)) | (intp)(packet_collect(row[1], w)) |
                       (intp)(packet_collect(row[2], w));
        intp word = as_intp((uintp)(packet_collect(corner, w)));
        intp apart_x = max(t.x0, max(t.x1, t.x2)) - min(t.x0, min(t.x1, t.x2));
        intp apart_y = max(t.y0, max(t.y1, t.y2)) - min(t.y0, min(t.y1, t.y2));
        intp compact = (apart_x < SMALL_SUBPIXELS) & (apart_y < SMALL_SUBPIXELS);
        // The area is exact where the triangle is compact; others are judged when they are set up.
        // Front faces have negative area here, since y points down.
        intp area = (t.x1 - t.x0) * (t.y2 - t.y0) - (t.x2 - t.x0) * (t.y1 - t.y0);
        intp hidden = area == 0;
        if (view.flags & VIEW_CULL_BACK_FACES)
            hidden |= (area > 0) & ((word & TRIANGLE_DOUBLE_SIDED) == 0);
        intp clipped = outside != 0;
        intp wanted = clipped | ((t.left <= t.right) & (t.top <= t.bottom) &
                                 ((compact == 0) | (hidden == 0)));
        intp is_small = wanted & (clipped == 0) & compact & (t.right - t.left < (int)params.small_size) &
                       (t.bottom - t.top < (int)params.small_size) & ((word & TRIANGLE_MASKED) == 0);
        int lane_wanted[CLGI_WIDTH];
        int lane_small[CLGI_WIDTH];
        packet_store(wanted, lane_wanted);
        packet_store(is_small, lane_small);
        for (uint k = 0; k < CLGI_WIDTH && packet + k < last; ++k) {
            small[small_count] = packet + k;
            small_count += lane_small[k] != 0;
            rest[rest_count] = packet + k;
            rest_count += (lane_wanted[k] != 0) & (lane_small[k] == 0);
        }
    }
    // The last packet's free lanes repeat a triangle that is there; they are not drawn.
    for (int k = 0; k < CLGI_WIDTH; ++k) small[small_count + k] = first;
    for (int n = 0; n < small_count; n += CLGI_WIDTH)
        draw_small(&view, params.stage, small + n, min(small_count - n, CLGI_WIDTH), triangles,
                  vertices, visibility);

    // Work-item i has the polygons from its first triangle's place on to itself.
    RasterRun run = {INT_MAX, INT_MAX, -1, -1, first, 0, 0, 0};
    for (int n = 0; n < rest_count; ++n) {
        uint triangle = rest[n];
        uint4 corners = triangles[triangle];
        ScreenVertex v0 = vertices[corners.x];
        ScreenVertex v1 = vertices[corners.y];
        ScreenVertex v2 = vertices[corners.z];
        uint outside = v0.outside | v1.outside | v2.outside;
        if (params.stage == RASTER_IDENTITY) continue;  // listed in the stage before
        int2 pixels[8];
        float closeness[8];
        int corner_count = 3;
        if (outside) {
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
        run.count += polygon_set_up(&view, pixels, closeness, corner_count, triangle, corners.w,
                                    polygons + first + run.count, &run);
    }
    if (run.count > 0) runs[atomic_inc(run_count)] = run;
}
