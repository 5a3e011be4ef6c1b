// Surfaces that hemicubes see, as places of further records: directions of a cosine lobe about the
// normal, so that what sends more light per albedo is met more often.
//                                          [derived: importance from the eye, as Segovia06 has it]
//
// Work size    1D, one work-item a pick; any local size; tail guarded
// Writes       its own place of the planes; a normal of 0 where the direction leaves the scene
//              or meets a back that nothing is reflected by
// SPDX-License-Identifier: MIT
#include "cache/sees.clh"
#include "clgi/shared/cache.h"
#include "clgi/shared/halton.h"
#include "gbuffer/hit.clh"
#include "gbuffer/visibility.clh"
#include "luminance.clh"

kernel void cache_pick(
    const CacheParams    params,
    const SceneInfo      info,
    global const View*   restrict views,       // five of each record
    global const ulong*  restrict visibility,  // of all records
    SCENE_ARGUMENTS,
    global float*        restrict places)      // [PICK_PLANES][pick_stride]
{
    uint item = (uint)get_global_id(0);
    if (item >= params.count * params.picks) return;
    SceneBuffers scene = SCENE_BUFFERS;
    uint record = item / params.picks;
    uint index = (params.first + record) * params.picks + item % params.picks + params.first_sample + 1;
    global const View* faces = views + 5 * (params.first + record);
    float radius = sqrt(radical_inverse(index, 2)), angle = 2.0f * CLGI_PI * radical_inverse(index, 3);
    float a = radius * cos(angle), b = radius * sin(angle);
    float c = sqrt(fmax(1.0f - radius * radius, 1e-6f));

    // Faces: 0 along the normal; 1, 3 along +-a; 2, 4 along +-b (gbuffer/cubes.cl).
    uint face = 0;
    float side = fabs(a) >= fabs(b) ? a : b;
    if (fabs(side) > c) face = (fabs(a) >= fabs(b) ? 1 : 2) + (side < 0.0f ? 2 : 0);
    View view = faces[face];
    float3 ray = a * faces[0].right.xyz + b * faces[0].up.xyz + c * faces[0].forward.xyz;
    float depth = fmax(dot(ray, view.forward.xyz), 1e-6f);
    float x = dot(ray, view.right.xyz) / depth, y = dot(ray, view.up.xyz) / depth;
    int across = (int)((x - view.window.x + view.right.w) / (2.0f * view.right.w) * (float)view.width);
    int down = (int)((view.window.y + view.up.w - y) / (2.0f * view.up.w) * (float)view.height);
    across = clamp(across, 0, (int)view.width - 1);
    down = clamp(down, 0, (int)view.height - 1);
    // The ray of the pixel's centre, whose triangle is known.
    x = ((float)across + 0.5f) * (2.0f * view.right.w / (float)view.width) - view.right.w + view.window.x;
    y = view.up.w - ((float)down + 0.5f) * (2.0f * view.up.w / (float)view.height) + view.window.y;
    int triangle = visibility_triangle(
        visibility[view.first_pixel + (uint)down * view.width + (uint)across]);
    Surface surface = view_surface(&view, packet_splat(x), packet_splat(y), (intp)(triangle),
                                   &scene, info.flags);
    int front[CLGI_WIDTH];
    packet_store(surface.front, front);
    int sends = triangle >= 0 &&
                (front[0] || (triangles[triangle].w & (uint)TRIANGLE_DOUBLE_SIDED));
    floatp values[RECORD_PLANES] = {surface.x,           surface.y,           surface.z,
                                    surface.normal_x,    surface.normal_y,    surface.normal_z,
                                    surface.geometric_x, surface.geometric_y, surface.geometric_z};
    for (uint plane = 0; plane < RECORD_PLANES; ++plane) {
        float lanes[CLGI_WIDTH];
        packet_store(values[plane], lanes);
        places[plane * params.pick_stride + item] = sends ? lanes[0] : 0.0f;
    }
    float red[CLGI_WIDTH], green[CLGI_WIDTH], blue[CLGI_WIDTH];
    packet_store(surface.base_r, red);
    packet_store(surface.base_g, green);
    packet_store(surface.base_b, blue);
    float3 albedo = (float3)(0.0f);
    if (sends)
        albedo = cache_albedo(materials[triangles[triangle].w & TRIANGLE_MATERIAL].reflectance,
                              (float3)(red[0], green[0], blue[0]));
    places[PICK_REFLECTANCE * params.pick_stride + item] =
        luminance(albedo.x, albedo.y, albedo.z);
    places[PICK_ALBEDO * params.pick_stride + item] = albedo.x;
    places[(PICK_ALBEDO + 1) * params.pick_stride + item] = albedo.y;
    places[(PICK_ALBEDO + 2) * params.pick_stride + item] = albedo.z;
}
