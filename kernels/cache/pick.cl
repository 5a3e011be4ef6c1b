// Surfaces that hemicubes see, as places of further records: directions of a cosine lobe about the
// normal, so that what sends more light per albedo is met more often.
//                                          [derived: importance from the eye, as Segovia06 has it]
//
// Work size    1D, one work-item for every CLGI_WIDTH picks (rounded up); any local size
// Writes       their own places of the planes; a normal of 0 where the direction leaves the scene
//              or meets a back that nothing is reflected by
// SPDX-License-Identifier: MIT
#include "cache/sees.clh"
#include "clgi/shared/cache.h"
#include "clgi/shared/halton.h"
#include "gbuffer/hit.clh"
#include "gbuffer/visibility.clh"
#include "luminance.clh"

// The pixel of a hemicube that direction number `index` of its lobe goes through: the ray through its
// centre, and the triangle there, or -1.
static int pick_ray(global const View* faces, global const ulong* visibility, uint index,
                    float3* begin, float3* direction, float3* axis) {
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
    x = ((float)across + 0.5f) * (2.0f * view.right.w / (float)view.width) - view.right.w + view.window.x;
    y = view.up.w - ((float)down + 0.5f) * (2.0f * view.up.w / (float)view.height) + view.window.y;
    *begin = view.eye.xyz;
    *axis = view.forward.xyz;
    *direction = view.forward.xyz + x * view.right.xyz + y * view.up.xyz;
    return visibility_triangle(
        visibility[view.first_pixel + (uint)down * view.width + (uint)across]);
}

kernel void cache_pick(
    const CacheParams    params,
    const SceneInfo      info,
    global const View*   restrict views,       // five of each record
    global const ulong*  restrict visibility,  // of all records
    SCENE_ARGUMENTS,
    global float*        restrict places)      // [PICK_PLANES][pick_stride]
{
    uint item = (uint)get_global_id(0) * CLGI_WIDTH, count = params.count * params.picks;
    if (item >= count) return;
    SceneBuffers scene = SCENE_BUFFERS;
    float ray[9][CLGI_WIDTH];
    int shown[CLGI_WIDTH];
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        uint pick = min(item + k, count - 1), record = params.first + pick / params.picks;
        uint index = record * params.picks + pick % params.picks + params.first_sample + 1;
        float3 begin, direction, axis;
        shown[k] = pick_ray(views + 5 * record, visibility, index, &begin, &direction, &axis);
        float parts[9] = {begin.x, begin.y, begin.z, direction.x, direction.y, direction.z,
                          axis.x,  axis.y,  axis.z};
        for (int n = 0; n < 9; ++n) ray[n][k] = parts[n];
    }
    ViewRays rays = {packet_load(ray[0]), packet_load(ray[1]), packet_load(ray[2]),
                     packet_load(ray[3]), packet_load(ray[4]), packet_load(ray[5]),
                     packet_load(ray[6]), packet_load(ray[7]), packet_load(ray[8])};
    View view = views[5 * params.first];  // all have pixels of one size
    Surface surface = ray_surface(&view, &rays, packet_load(shown), &scene, info.flags);
    int front[CLGI_WIDTH], sends[CLGI_WIDTH];
    float base[3][CLGI_WIDTH], albedo[3][CLGI_WIDTH];
    packet_store(surface.front, front);
    packet_store(surface.base_r, base[0]);
    packet_store(surface.base_g, base[1]);
    packet_store(surface.base_b, base[2]);
    for (int k = 0; k < CLGI_WIDTH; ++k) {
        uint word = triangles[max(shown[k], 0)].w;
        sends[k] = -(shown[k] >= 0 && (front[k] || (word & (uint)TRIANGLE_DOUBLE_SIDED)));
        float3 of = cache_albedo(materials[word & TRIANGLE_MATERIAL].reflectance,
                                 (float3)(base[0][k], base[1][k], base[2][k]));
        albedo[0][k] = of.x;
        albedo[1][k] = of.y;
        albedo[2][k] = of.z;
    }
    intp sending = packet_load(sends) != 0;
    floatp red = packet_load(albedo[0]), green = packet_load(albedo[1]), blue = packet_load(albedo[2]);
    floatp values[PICK_PLANES];
    values[0] = surface.x;
    values[1] = surface.y;
    values[2] = surface.z;
    values[3] = surface.normal_x;
    values[4] = surface.normal_y;
    values[5] = surface.normal_z;
    values[6] = surface.geometric_x;
    values[7] = surface.geometric_y;
    values[8] = surface.geometric_z;
    values[PICK_REFLECTANCE] = luminance(red, green, blue);
    values[PICK_ALBEDO] = red;
    values[PICK_ALBEDO + 1] = green;
    values[PICK_ALBEDO + 2] = blue;
    for (uint plane = 0; plane < PICK_PLANES; ++plane)
        packet_store(packet_select(packet_zero, values[plane], sending),
                     places + plane * params.pick_stride + item);
}
