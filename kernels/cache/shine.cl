// Light of small lit places at records: VPLs on them, whose shadows their own hemicubes know. From
// inside a hole its opening is wide; from a record it would fall between the pixels.
//
//   R_i += sum over VPLs Phi cos cos' k V      k: the kernel of a disc (lights/disc.clh)
//   V: 1 where the VPL lies above the record's surface, and the plane of what its hemicube shows there
//      is not nearer than the record
//
// VPLs are lifted off the plane of the record, from h to sqrt(h^2 + d^2 / n): n others lie within d of it,
// so it stands for a disc of that radius, over which light a centimetre from a lit place, such as within a
// lamp's shade, is spread. On a plane of records the sum stays the flux of the VPL.
//                      [derived: VPLs, Keller97; of a disc by the density of places]
//
// Work size    1D, one work-item a record; any local size; tail guarded
// Writes       its own reflected light
// Cost         about 120 flops a VPL that both face
// SPDX-License-Identifier: MIT
#include "cache/lookup.clh"
#include "clgi/shared/lights.h"
#include "clgi/shared/scene.h"
#include "gbuffer/locate.clh"
#include "gbuffer/visibility.clh"
#include "lights/disc.clh"
#include "scene/buffers.clh"

#define SHINE_SLACK 0.01f  // of a distance

// Whether a hemicube, whose faces are given, sees a place.
static int shine_sees(global const View* faces, global const ulong* visibility, float3 place,
                      global const uint4* triangles, global const float4* positions) {
    ViewPoint at = gbuffer_locate(faces, 0, 5, place);
    if (at.view < 0) return 0;
    View view = faces[at.view];
    uint column = min((uint)at.pixel.x, view.width - 1), row = min((uint)at.pixel.y, view.height - 1);
    int triangle = visibility_triangle(visibility[view.first_pixel + row * view.width + column]);
    if (triangle < 0) return 1;
    uint4 corners = triangles[triangle];
    float3 a = positions[corners.x].xyz, eye = view.eye.xyz;
    float3 normal = cross(positions[corners.y].xyz - a, positions[corners.z].xyz - a);
    float toward = dot(normal, place - eye), plane = dot(normal, a - eye);
    // The plane lies plane / toward of the way to the place.
    return !(plane / toward > 0.0f && plane / toward < 1.0f - SHINE_SLACK);
}

// Square of the radius that a record stands for.
static float shine_area(const CacheTree* tree, global const uint* nodes, global const uint* lists,
                        global const float* planes, uint record, float3 point, float3 normal) {
    CacheVector here = {packet_splat(point.x), packet_splat(point.y), packet_splat(point.z)};
    CacheVector up = {packet_splat(normal.x), packet_splat(normal.y), packet_splat(normal.z)};
    CacheShare beside;
    cache_lookup(tree, nodes, lists, planes, here, up, CACHE_FEW, &beside, 0);
    float others = 0.0f, widest = 0.0f;
    for (uint i = 0; i < beside.count; ++i) {
        float weight[CLGI_WIDTH];
        packet_store(beside.weight[i], weight);
        uint other = (uint)beside.record[i][0];
        if (other == record || !(weight[0] > 0.0f)) continue;
        global const float* at = planes + other;
        float3 d = (float3)(at[0], at[tree->stride], at[2 * tree->stride]) - point;
        widest = fmax(widest, dot(d, d));
        others += 1.0f;
    }
    return widest / fmax(others, 1.0f);
}

kernel void cache_shine(
    const CacheParams    params,
    const CacheTree      tree,
    const SpotParams     of,
    global const View*   restrict views,       // five of each VPL
    global const ulong*  restrict visibility,  // of all VPLs
    global const uint*   restrict nodes,
    global const uint*   restrict lists,
    global const float*  restrict planes,      // [RECORD_PLANES][stride] of all records
    SCENE_ARGUMENTS,
    global const Vpl*    restrict spots,       // [sample_count]
    global float*        restrict reflected)   // [3][stride] R
{
    uint item = (uint)get_global_id(0);
    if (item >= params.count) return;
    uint record = params.first + item, stride = params.stride;
    global const float* at = planes + record;
    float3 point = (float3)(at[0], at[stride], at[2 * stride]);
    at += RECORD_NORMAL * stride;
    float3 normal = (float3)(at[0], at[stride], at[2 * stride]), sum = (float3)(0.0f);
    at += (RECORD_GEOMETRIC - RECORD_NORMAL) * stride;
    float3 ground = (float3)(at[0], at[stride], at[2 * stride]);
    float stands_for = shine_area(&tree, nodes, lists, planes, record, point, normal);
    for (uint k = 0; k < of.sample_count; ++k) {
        Vpl spot = spots[k];
        float3 to = spot.position.xyz - point;
        float arriving = dot(to, normal), leaving = -dot(to, spot.normal.xyz);
        if (!(arriving > 0.0f && leaving > 0.0f && dot(to, ground) > 0.0f)) continue;
        if (!shine_sees(views + 5 * k, visibility, point, triangles, positions)) continue;
        float lifted = sqrt(fma(arriving, arriving, stands_for));
        to += (lifted - arriving) * normal;
        float factor = disc_kernel_one(-lifted * dot(to, spot.normal.xyz), dot(to, to),
                                       spot.position.w, spot.normal.w);
        sum += spot.flux.xyz * (factor * (1.0f / CLGI_PI));
    }
    reflected[record] += sum.x;
    reflected[stride + record] += sum.y;
    reflected[2 * stride + record] += sum.z;
}
