// Draws triangles into a visibility buffer: small ones at once, the others set up for raster_large.
//
//   E(x, y) = (qx - px)(y - py) - (qy - py)(x - px) >= 0 for the three edges p -> q
//
// in integers, with the top-left rule for E = 0, so that a shared edge covers each pixel exactly
// once. Triangles that cross the near plane or leave the guard band are clipped; a shared edge is
// cut from the inside end in both its triangles, hence at the same point.
// [derived: fixed-point edge functions, after Pineda, A Parallel Algorithm for Polygon Rasterization]
//
// Work size    1D, one work-item a triangle; any local size; tail guarded
// Writes       visibility by integer minimum (no order), polygons (any order; all are drawn)
#include "gbuffer/project.clh"
#include "gbuffer/visibility.clh"
#include "clgi/shared/scene.h"

// Cuts a convex polygon by distance >= 0. Returns the number of corners left.
static int clip(float3* corners, const float* distance, int count) {
    float3 kept[9];
    int left = 0;
    for (int i = 0; i < count; ++i) {
        int next = i + 1 < count ? i + 1 : 0;
        float here = distance[i];
        float there = distance[next];
        if (here >= 0.0f) kept[left++] = corners[i];
        if (here >= 0.0f && there < 0.0f)
            kept[left++] = corners[i] + (corners[next] - corners[i]) * (here / (here - there));
        else if (here < 0.0f && there >= 0.0f)
            kept[left++] = corners[next] + (corners[i] - corners[next]) * (there / (there - here));
        if (left > 8) left = 8;
    }
    for (int i = 0; i < left; ++i) corners[i] = kept[i];
    return left;
}

static int clip_to_view(const View* view, float3* corners) {
    float distance[8];
    int count = 3;
    for (int i = 0; i < count; ++i) distance[i] = corners[i].z - view->forward.w;
    count = clip(corners, distance, count);
    float2 guard = 2.0f * (float)GUARD_PIXELS / (float2)((float)view->width, (float)view->height) - 1.0f;
    for (int side = 0; side < 4 && count > 2; ++side) {
        float sign = side & 1 ? -1.0f : 1.0f;
        for (int i = 0; i < count; ++i) {
            float reach = view->eye.w == 0.0f ? corners[i].z : 1.0f;
            float across = side < 2 ? corners[i].x - view->window.x * reach
                                    : corners[i].y - view->window.y * reach;
            float limit = side < 2 ? guard.x * view->right.w : guard.y * view->up.w;
            distance[i] = limit * reach - sign * across;
        }
        count = clip(corners, distance, count);
    }
    return count;
}

// First and last pixel whose centre can lie between two coordinates.
static int2 pixel_range(int low, int high, uint size) {
    return (int2)(max((low + SUBPIXELS / 2 - 1) >> 8, 0),
                  min((high - SUBPIXELS / 2) >> 8, (int)size - 1));
}

static long twice_area(int2 a, int2 b, int2 c) {
    return (long)(b.x - a.x) * (c.y - a.y) - (long)(c.x - a.x) * (b.y - a.y);
}

// Seen from behind and made to be seen from one side only? Front faces have negative area here,
// since y points down.
static int culled(const View* view, uint material, long area) {
    return area > 0 && (view->flags & VIEW_CULL_BACK_FACES) &&
           !(material & (uint)TRIANGLE_DOUBLE_SIDED);
}

static void set_up_polygon(const View* view, const int2* corners, const float* closeness, int count,
                           uint triangle, uint material, global RasterPolygon* polygons,
                           volatile global uint* polygon_count) {
    long area = 0;
    long widest = 0;
    int widest_at = 1;
    int2 low = corners[0];
    int2 high = corners[0];
    for (int i = 1; i < count; ++i) {
        low = min(low, corners[i]);
        high = max(high, corners[i]);
        if (i + 1 == count) break;
        long part = twice_area(corners[0], corners[i], corners[i + 1]);
        area += part;
        long size = part < 0 ? -part : part;
        if (size > widest) {
            widest = size;
            widest_at = i;
        }
    }
    if (area == 0 || culled(view, material, area)) return;
    int2 columns = pixel_range(low.x, high.x, view->width);
    int2 rows = pixel_range(low.y, high.y, view->height);
    if (columns.x > columns.y || rows.x > rows.y) return;

    RasterPolygon out;
    float closest = 0.0f;
    float farthest = INFINITY;
    for (int i = 0; i < 8; ++i) {
        // Padding repeats the last corner: an edge of no length, which hides nothing.
        int from = min(i, count - 1);
        if (area < 0) from = max(count - 1 - i, 0);
        out.x[i] = corners[from].x;
        out.y[i] = corners[from].y;
        closest = max(closest, closeness[from]);
        farthest = min(farthest, closeness[from]);
    }
    // The plane of closeness through the widest part of the fan.
    float2 a = convert_float2(corners[0]) / (float)SUBPIXELS;
    float2 b = convert_float2(corners[widest_at] - corners[0]) / (float)SUBPIXELS;
    float2 c = convert_float2(corners[widest_at + 1] - corners[0]) / (float)SUBPIXELS;
    float cb = closeness[widest_at] - closeness[0];
    float cc = closeness[widest_at + 1] - closeness[0];
    float across = b.x * c.y - c.x * b.y;
    out.slope_x = across == 0.0f ? 0.0f : (cb * c.y - cc * b.y) / across;
    out.slope_y = across == 0.0f ? 0.0f : (cc * b.x - cb * c.x) / across;
    out.closeness = closeness[0];
    out.origin_x = a.x;
    out.origin_y = a.y;
    out.closest = closest;
    out.farthest = farthest;
    out.triangle = triangle;
    out.material = material;
    out.count = (uint)count;
    out.left = columns.x;
    out.right = columns.y;
    out.top = rows.x;
    out.bottom = rows.y;
    out.pad0_ = 0;
    out.pad1_ = 0;
    polygons[atomic_inc(polygon_count)] = out;
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
    uint triangle = (uint)get_global_id(0);
    if (triangle >= params.triangle_count) return;

    uint4 words = triangles[triangle];
    ScreenVertex v0 = vertices[words.x];
    ScreenVertex v1 = vertices[words.y];
    ScreenVertex v2 = vertices[words.z];

    if (v0.outside | v1.outside | v2.outside) {
        // All before the near plane: nothing to see.
        if (params.stage == RASTER_IDENTITY) return;
        if (v0.outside & v1.outside & v2.outside & VERTEX_BEFORE_NEAR) return;
        float3 corners[9] = {gbuffer_to_view(&view, positions[words.x]),
                             gbuffer_to_view(&view, positions[words.y]),
                             gbuffer_to_view(&view, positions[words.z])};
        int count = clip_to_view(&view, corners);
        if (count < 3) return;
        int2 pixels[8];
        float closeness[8];
        for (int i = 0; i < count; ++i) {
            pixels[i] = gbuffer_to_subpixels(&view, gbuffer_to_window(&view, corners[i]));
            closeness[i] = gbuffer_closeness(&view, corners[i].z);
        }
        set_up_polygon(&view, pixels, closeness, count, triangle, words.w, polygons,
                       polygon_count);
        return;
    }

    int2 columns = pixel_range(min(v0.x, min(v1.x, v2.x)), max(v0.x, max(v1.x, v2.x)), view.width);
    int2 rows = pixel_range(min(v0.y, min(v1.y, v2.y)), max(v0.y, max(v1.y, v2.y)), view.height);
    if (columns.x > columns.y || rows.x > rows.y) return;

    // Alpha is looked up a packet at a time, so masked triangles wait for raster_large too.
    int small = columns.y - columns.x < (int)params.small_size &&
                rows.y - rows.x < (int)params.small_size &&
                max(v0.x, max(v1.x, v2.x)) - min(v0.x, min(v1.x, v2.x)) < 8192 &&
                max(v0.y, max(v1.y, v2.y)) - min(v0.y, min(v1.y, v2.y)) < 8192 &&
                !(words.w & TRIANGLE_MASKED);
    if (!small) {
        if (params.stage == RASTER_IDENTITY) return;
        int2 pixels[3] = {(int2)(v0.x, v0.y), (int2)(v1.x, v1.y), (int2)(v2.x, v2.y)};
        float closeness[3] = {v0.closeness, v1.closeness, v2.closeness};
        set_up_polygon(&view, pixels, closeness, 3, triangle, words.w, polygons, polygon_count);
        return;
    }

    // Small: relative to the first corner everything fits 32 bits.
    int bx = v1.x - v0.x, by = v1.y - v0.y;
    int cx = v2.x - v0.x, cy = v2.y - v0.y;
    float b_closer = v1.closeness - v0.closeness;
    float c_closer = v2.closeness - v0.closeness;
    int area = bx * cy - cx * by;
    if (area == 0 || culled(&view, words.w, area)) return;
    if (area < 0) {
        int swap = bx; bx = cx; cx = swap;
        swap = by; by = cy; cy = swap;
        float swap_closer = b_closer; b_closer = c_closer; c_closer = swap_closer;
        area = -area;
    }
    // Edges 0 -> b, b -> c, c -> 0; an edge owns its pixels when it is top or left.
    int dx0 = bx, dy0 = by, dx1 = cx - bx, dy1 = cy - by, dx2 = -cx, dy2 = -cy;
    int own0 = dy0 < 0 || (dy0 == 0 && dx0 > 0) ? 0 : -1;
    int own1 = dy1 < 0 || (dy1 == 0 && dx1 > 0) ? 0 : -1;
    int own2 = dy2 < 0 || (dy2 == 0 && dx2 > 0) ? 0 : -1;
    int x = columns.x * SUBPIXELS + SUBPIXELS / 2 - v0.x;
    int y = rows.x * SUBPIXELS + SUBPIXELS / 2 - v0.y;
    int row0 = dx0 * y - dy0 * x + own0;
    int row1 = dx1 * (y - by) - dy1 * (x - bx) + own1;
    int row2 = dx2 * y - dy2 * x + own2;
    float per_area = 1.0f / (float)area;
    float slope_x = (b_closer * (float)cy - c_closer * (float)by) * per_area;
    float slope_y = (c_closer * (float)bx - b_closer * (float)cx) * per_area;
    float closest = max(v0.closeness, max(v1.closeness, v2.closeness));
    float farthest = min(v0.closeness, min(v1.closeness, v2.closeness));

    for (int py = rows.x; py <= rows.y; ++py, y += SUBPIXELS) {
        int e0 = row0, e1 = row1, e2 = row2;
        int along = x;
        for (int px = columns.x; px <= columns.y; ++px, along += SUBPIXELS) {
            if ((e0 | e1 | e2) >= 0) {
                float closeness = v0.closeness + (float)along * slope_x + (float)y * slope_y;
                closeness = clamp(closeness, farthest, closest);
                uint pixel = view.first_pixel + (uint)py * view.width + (uint)px;
                visibility_put(visibility + pixel, closeness, triangle, params.stage);
            }
            e0 -= dy0 * SUBPIXELS;
            e1 -= dy1 * SUBPIXELS;
            e2 -= dy2 * SUBPIXELS;
        }
        row0 += dx0 * SUBPIXELS;
        row1 += dx1 * SUBPIXELS;
        row2 += dx2 * SUBPIXELS;
    }
}
