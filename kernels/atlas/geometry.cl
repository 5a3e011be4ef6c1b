// The G-buffer G = [U, W, I] at the corners of the mesh M, with derivatives.
//
// What a VPL sees at a corner lies on the plane of a triangle (a, a + e1, a + e2) with the normal
// n = e1 x e2. On it 1/depth and atlas coordinates over depth are linear in the ray r = forward +
// x right + y up:
//
//   W = m.r,  m = n / n.(a - eye)
//   U = u_a W + du_1 (g_1.r - g_1.(a - eye) W) + du_2 (g_2.r - g_2.(a - eye) W),
//   g_1 = e2 x n / |n|^2,  g_2 = n x e1 / |n|^2
//                                        [Schaerfig16, section 4.2; derived: linear on the screen]
//
// Unlike paper  at the mesh's corners alone; derivatives in closed form, not by differences of
//               pixels; N and D are not stored, because a texel has its normal and D follows from W
// Work size     1D, one work-item for every corner of every hemicube; any local size; tail guarded
// Writes        its own corner
// SPDX-License-Identifier: MIT
#include "atlas/mesh.clh"
#include "packet.clh"

kernel void atlas_geometry(
    const MeshParams       params,
    global const View*     restrict views,       // [5 * shooter_count]
    global const ulong*    restrict visibility,  // [pixels of the views]
    global const uint4*    restrict triangles,   // [triangle_count] three vertices, material
    global const float4*   restrict positions,   // [vertex_count] local frame
    global const float2*   restrict uvs,         // [3 * triangle_count] texels of the page
    global const uint*     restrict charts,      // [triangle_count]
    global MeshCorner*     restrict corners)     // [shooter_count][MESH_CORNERS]
{
    uint item = (uint)get_global_id(0);
    uint squares = params.squares, row = squares + 1;
    uint shooter = item / MESH_CORNERS(squares);
    if (shooter >= params.shooter_count) return;
    uint place = item % MESH_CORNERS(squares);
    uint face = place < row * row ? 0 : 1 + (place - row * row) / (row * (squares / 2 + 1));
    place -= mesh_first_corner(squares, face);
    float2 at = mesh_place(squares, place % row, place / row);

    MeshCorner out;
    out.u = out.v = out.w = out.u_right = out.v_right = out.w_right = 0.0f;
    out.u_up = out.v_up = out.w_up = out.pad0_ = out.pad1_ = 0.0f;
    out.chart = MESH_NO_CHART;
    corners[item] = out;

    global const View* view = views + 5 * shooter + face;
    int2 pixel = mesh_pixel(view, at);
    ulong word = visibility[view->first_pixel + (uint)pixel.y * view->width + (uint)pixel.x];
    if (word == (ulong)-1) return;
    uint triangle = (uint)word;
    uint chart = charts[triangle];
    if (chart == MESH_NO_CHART) return;

    uint4 vertex = triangles[triangle];
    float3 first = positions[vertex.x].xyz;
    float3 e1 = positions[vertex.y].xyz - first;
    float3 e2 = positions[vertex.z].xyz - first;
    float3 from_eye = first - view->eye.xyz;
    float3 n = cross(e1, e2);
    float square = dot(n, n), distance = dot(n, from_eye);
    if (!(square > 0.0f) || distance == 0.0f) return;
    float3 m = n / distance;
    float3 g1 = cross(e2, n) / square, g2 = cross(n, e1) / square;
    g1 -= dot(g1, from_eye) * m;
    g2 -= dot(g2, from_eye) * m;
    float2 base = uvs[3 * triangle];
    float2 d1 = uvs[3 * triangle + 1] - base, d2 = uvs[3 * triangle + 2] - base;
    float3 u = base.x * m + d1.x * g1 + d2.x * g2;
    float3 v = base.y * m + d1.y * g1 + d2.y * g2;

    // The corner lies half a pixel beside the centre at which the triangle was seen.
    float3 right = view->right.xyz, up = view->up.xyz;
    float3 ray = view->forward.xyz + at.x * right + at.y * up;
    float2 centre = mesh_centre(view, pixel);
    float seen = dot(m, view->forward.xyz + centre.x * right + centre.y * up);
    out.w = dot(m, ray);
    if (!(seen > 0.0f) || !(out.w >= MESH_LEAST * seen)) return;
    out.u = dot(u, ray);
    out.v = dot(v, ray);
    out.u_right = dot(u, right);
    out.v_right = dot(v, right);
    out.w_right = dot(m, right);
    out.u_up = dot(u, up);
    out.v_up = dot(v, up);
    out.w_up = dot(m, up);
    uint largest = max(max(as_uint(out.u) & 0x7fffffffu, as_uint(out.v) & 0x7fffffffu),
                       as_uint(out.w) & 0x7fffffffu);
    if (largest >= NOT_FINITE) return;
    out.chart = chart;
    corners[item] = out;
}
