// Views around points of surfaces that the device itself has chosen: hemicubes, or cubes.
//
//   eye = p + lift n;  hemicube: right = normalize(h x n), up = right x n, h any axis across n; turned
//   about n where that is asked for
// [derived: the frame of host/lights/emitters for area lights]
//
// Work size    1D, one work-item a point; any local size; tail guarded
// Writes       its own 5 or 6 views; a point without normal has views in which nothing is seen
// SPDX-License-Identifier: MIT
#include "clgi/shared/gbuffer.h"
#include "clgi/shared/halton.h"

static float3 point_row(global const float* points, uint plane, uint stride, uint point) {
    return (float3)(points[plane * stride + point], points[(plane + 1) * stride + point],
                    points[(plane + 2) * stride + point]);
}

kernel void gbuffer_cubes(
    const CubeParams     params,
    global const float*  restrict points,  // [POINT_PLANES][stride] local frame
    global const uint*   restrict chosen,  // [first_chosen + point_count] which points
    global View*         restrict views)   // [first_view + point_count * faces]
{
    uint item = (uint)get_global_id(0);
    if (item >= params.point_count) return;
    uint point = chosen[params.first_chosen + item];
    float3 position = point_row(points, 0, params.stride, point);
    float3 normal = point_row(points, GBUFFER_NORMAL, params.stride, point);
    int valid = dot(normal, normal) > 0.0f;

    // The frame: z is +y, -y ... of a cube, the normal of a hemicube.
    float3 axis[3] = {(float3)(1.0f, 0.0f, 0.0f), (float3)(0.0f, 1.0f, 0.0f),
                      (float3)(0.0f, 0.0f, 1.0f)};
    if (params.faces == 5) {
        float3 helper = fabs(normal.y) < 0.9f ? axis[1] : axis[0];
        axis[0] = valid ? normalize(cross(helper, normal)) : axis[0];
        axis[1] = valid ? cross(axis[0], normal) : axis[1];
        axis[2] = valid ? normal : axis[2];
        if (params.turned) {
            float angle = 2.0f * CLGI_PI * radical_inverse(point + 1, 2);
            float3 a = cos(angle) * axis[0] + sin(angle) * axis[1];
            axis[1] = cos(angle) * axis[1] - sin(angle) * axis[0];
            axis[0] = a;
        }
    }
    uint whole = params.size * params.size;
    uint of_point = params.faces == 5 ? 3 * whole : 6 * whole;
    uint pixel = params.first_pixel + item * of_point;
    for (uint face = 0; face < params.faces; ++face) {
        float3 forward, up;
        if (params.faces == 6) {
            forward = face % 2 == 0 ? axis[face / 2] : -axis[face / 2];
            up = axis[(face / 2 + 1) % 3];
        } else {
            float3 side = face % 2 == 1 ? axis[0] : axis[1];
            forward = face == 0 ? axis[2] : face < 3 ? side : -side;
            up = face == 0 ? axis[1] : axis[2];
        }
        float3 right = face == 0 && params.faces == 5 ? axis[0] : cross(forward, up);
        int half_face = params.faces == 5 && face > 0;
        View view;
        view.eye = (float4)(position + params.lift * normal, 0.0f);
        view.right = (float4)(right, 1.0f);
        view.up = (float4)(up, half_face ? 0.5f : 1.0f);
        view.forward = (float4)(forward, valid ? params.near : INFINITY);
        view.window = (float4)(0.0f, half_face ? 0.5f : 0.0f, 0.0f, CUBE_FOOTPRINT);
        view.width = params.size;
        view.height = half_face ? params.size / 2 : params.size;
        view.first_pixel = pixel;
        view.flags = 0;
        views[params.first_view + item * params.faces + face] = view;
        pixel += view.width * view.height;
    }
}
