// Light of a batch of VPLs, projected into the atlas through the triangles of the mesh M, and added
// to what is there.
//
//   I(u, v) += sum_i F'_i(u, v) E_i lit_i(u, v),   E_i = a_i rho_i A_i I_i
//                                              [Schaerfig16, Eq. 9, sections 4.1, 4.2 and 4.3]
//
// A texel is lit through the one triangle of M that it lies in, as seen from the VPL, if a copy of
// that triangle is in the texel's chart and reaches as far as the texel. So none is lit twice,
// although copies overlap where they are extrapolated.
//
// Unlike paper  texels look for their triangle, so that no two write one texel; form factor by the
//               texel's own place and normal, as in gather
// Work size     1D, one work-item a texel; any local size; tail guarded
// Writes        its own texel; beside the light, the share of the hemisphere that the VPLs fill
// SPDX-License-Identifier: MIT
#include "atlas/shadow.clh"
#include "vpl/exchange.clh"

static float3 project_row(global const float* from, uint stride) {
    return (float3)(from[0], from[stride], from[2 * stride]);
}

// The face of a hemicube in which a direction in front of it is seen.
static uint project_face(global const View* views, float3 d) {
    float a = dot(d, views->right.xyz), b = dot(d, views->up.xyz);
    float c = dot(d, views->forward.xyz);
    if (c >= fmax(fabs(a), fabs(b))) return 0;
    if (fabs(a) >= fabs(b)) return a < 0.0f ? 3 : 1;
    return b < 0.0f ? 4 : 2;
}

kernel void atlas_project(
    const FillParams        params,
    const MeshParams        mesh,
    global const uint*      restrict chosen,       // [first_shooter + shooter_count] sites
    global const View*      restrict views,        // [5 * shooter_count]
    global const ulong*     restrict visibility,   // [pixels of the views]
    global const MeshCopy*  restrict copies,       // [shooter_count][MESH_TRIANGLES][MESH_COPIES]
    global const Site*      restrict sites,
    global const float*     restrict site_planes,  // [SITE_PLANES][site_stride]
    global const float*     restrict site_power,   // [3][site_stride] exposed lumen
    global const float*     restrict samples,      // [GBUFFER_PLANES][sample_stride]
    global const float*     restrict sample_power, // [3][sample_stride] exposed lumen
    global const float*     restrict texels,       // [>= GBUFFER_GEOMETRIC + 3][stride]
    global const int*       restrict places,       // [PLACE_PLANES][stride]
    global float*           restrict gathered,     // [3][stride] lux, exposed
    global float*           restrict filled)       // [stride] sum of form factors
{
    uint texel = params.first_texel + (uint)get_global_id(0);
    if (texel >= params.texel_count) return;
    uint stride = params.stride;
    float3 p = project_row(texels + texel, stride);
    float3 n = project_row(texels + GBUFFER_NORMAL * stride + texel, stride);
    float3 geometric = project_row(texels + GBUFFER_GEOMETRIC * stride + texel, stride);
    uint chart = (uint)places[PLACE_CHART * stride + texel];
    float u = (float)places[PLACE_COLUMN * stride + texel] + 0.5f;
    float v = (float)places[PLACE_ROW * stride + texel] + 0.5f;
    PointReceiver to;
    to.x = packet_splat(p.x), to.y = packet_splat(p.y), to.z = packet_splat(p.z);
    to.nx = packet_splat(n.x), to.ny = packet_splat(n.y), to.nz = packet_splat(n.z);
    Exchanged sum = {packet_zero, packet_zero, packet_zero, packet_zero};
    for (uint s = 0; s < params.shooter_count; ++s) {
        global const View* cube = views + 5 * s;
        float3 d = p - cube->eye.xyz;
        if (!(dot(d, geometric) < 0.0f) || !(dot(d, cube->forward.xyz) > 0.0f)) continue;
        uint face = project_face(cube, d);
        global const View* view = cube + face;
        float2 at = (float2)(dot(d, view->right.xyz), dot(d, view->up.xyz)) /
                    dot(d, view->forward.xyz);
        MeshTriangle t = mesh_around(mesh.squares, face, at);
        float2 from = mesh_place(mesh.squares, t.column, t.line);

        // Of the copies one at most is in the chart.
        global const MeshCopy* copy =
            copies + ((size_t)s * MESH_TRIANGLES(mesh.squares) + t.index) * MESH_COPIES;
        uint k = 0;
        while (k < MESH_COPIES && copy[k].chart != chart) ++k;
        if (k == MESH_COPIES) continue;
        float4 box = copy[k].box, depth = copy[k].depth;
        if (u < box.x || v < box.y || u > box.z || v > box.w) continue;
        float w = shadow_w(depth, from, at);
        if (!(w > 0.0f) || w < depth.w) continue;
        float lit = shadow_reaches(view, visibility, mesh.reach, depth, from, at);
        if (!(lit > 0.0f)) continue;

        uint site = chosen[params.first_shooter + s];
        Shooter shooter = exchange_shooter(sites, site_planes, params.site_stride, site);
        exchange_light(&shooter, site_power + site, params.site_stride, samples, sample_power,
                       params.sample_stride, &to, packet_splat(lit), &sum);
    }
    // All lanes are alike; there is one.
    float out[4][CLGI_WIDTH];
    packet_store(sum.r, out[0]);
    packet_store(sum.g, out[1]);
    packet_store(sum.b, out[2]);
    packet_store(sum.form_factor, out[3]);
    for (uint c = 0; c < 3; ++c) gathered[c * stride + texel] += out[c][0];
    filled[texel] += out[3][0];
}
