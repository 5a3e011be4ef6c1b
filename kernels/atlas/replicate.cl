// Every triangle of the mesh M, projected into each chart that one of its corners lies in.
//
//   q_k = U(p_k) / W(p_k)                                                  [Schaerfig16, Eq. 10]
//   q'_k = (U(p_1) + grad U (p_k - p_1)) / (W(p_1) + grad W (p_k - p_1))   [Schaerfig16, Eq. 11]
//
// p_1: the first corner in the chart; corners in other charts are extrapolated from it. A copy keeps
// what project needs: W over the triangle, from which the extrapolated distance |ray| / W follows
// exactly, and the box around q_k, inside the chart's own box.
//
// Where an extrapolated W is rejected (MESH_LEAST), the triangle reaches beyond the horizon of its
// plane and has no q_k there: then the box is the chart's, and project rejects texel by texel.
//
// Unlike paper  D is not extrapolated: it is not linear on the screen
// Work size     1D, one work-item for every triangle of every hemicube; any local size; tail guarded
// Writes        its own MESH_COPIES copies
// SPDX-License-Identifier: MIT
#include "atlas/mesh.clh"

// Added around the box: a texel, because texels are taken for their centres, and a share of its size,
// because a chart that is not quite flat bends between the corners.
#define MESH_MARGIN 1.0f
#define MESH_BEND 0.25f

kernel void atlas_replicate(
    const MeshParams          params,
    global const MeshCorner*  restrict corners,  // [shooter_count][MESH_CORNERS]
    global const float4*      restrict boxes,    // [chart_count] texels of the page, as MeshCopy::box
    global MeshCopy*          restrict copies)   // [shooter_count][MESH_TRIANGLES][MESH_COPIES]
{
    uint item = (uint)get_global_id(0);
    uint squares = params.squares, row = squares + 1;
    uint shooter = item / MESH_TRIANGLES(squares);
    if (shooter >= params.shooter_count) return;
    uint of_face = item % MESH_TRIANGLES(squares);
    uint whole = squares * squares;
    uint face = of_face < 2 * whole ? 0 : of_face / whole - 1;
    of_face -= mesh_first_triangle(squares, face);
    uint square = of_face / 2;
    MeshTriangle t = mesh_triangle(squares, face, square % squares, square / squares, of_face % 2);

    global const MeshCorner* first = corners + (size_t)shooter * MESH_CORNERS(squares) +
                                     mesh_first_corner(squares, face) + t.line * row + t.column;
    MeshCorner corner[3] = {first[0], first[t.step], first[t.step * (int)row]};
    float step = (float)t.step * 2.0f / (float)squares;
    float right[3] = {0.0f, step, 0.0f}, up[3] = {0.0f, 0.0f, -step};  // from the first corner

    for (int k = 0; k < MESH_COPIES; ++k) {
        MeshCopy out;
        out.depth = out.box = (float4)(0.0f);
        out.chart = corner[k].chart;
        for (int j = 0; j < k; ++j)
            if (corner[j].chart == corner[k].chart) out.chart = MESH_NO_CHART;
        out.pad0_ = out.pad1_ = out.pad2_ = 0;
        if (out.chart != MESH_NO_CHART) {
            MeshCorner from = corner[k];
            float least = MESH_LEAST * from.w;
            float w[3];
            float2 low = (float2)(FLT_MAX), high = (float2)(-FLT_MAX);
            int rejected = 0;
            for (int j = 0; j < 3; ++j) {
                float dx = right[j] - right[k], dy = up[j] - up[k];
                float u = fma(from.u_right, dx, fma(from.u_up, dy, from.u));
                float v = fma(from.v_right, dx, fma(from.v_up, dy, from.v));
                w[j] = fma(from.w_right, dx, fma(from.w_up, dy, from.w));
                int own = corner[j].chart == out.chart;
                u = own ? corner[j].u : u;
                v = own ? corner[j].v : v;
                w[j] = own ? corner[j].w : w[j];
                rejected |= !own && !(w[j] >= least);
                out.depth.w = own ? out.depth.w : least;
                float2 q = (float2)(u, v) / w[j];
                low = fmin(low, q);
                high = fmax(high, q);
            }
            out.depth.x = w[0];
            out.depth.y = (w[1] - w[0]) / step;
            out.depth.z = (w[0] - w[2]) / step;
            float4 box = boxes[out.chart];
            if (!rejected) {
                float2 margin = MESH_MARGIN + MESH_BEND * (high - low);
                box.xy = fmax(box.xy, low - margin);
                box.zw = fmin(box.zw, high + margin);
            }
            out.box = box;
        }
        copies[(size_t)item * MESH_COPIES + k] = out;
    }
}
