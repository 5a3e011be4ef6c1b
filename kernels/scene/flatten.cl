// Normals of triangles whose mesh has none: those of the plane, up for a triangle without area.
// [derived: glTF 2.0, section 3.7.2.1, flat normals where there are none]
//
// Cost         60 B read and 48 B written a triangle
// Work size    1D, one work-item a triangle; any local size; tail guarded
// Writes       the normals of its three vertices, which no other triangle has (validate checks it)
// SPDX-License-Identifier: MIT
#include "clgi/shared/scene.h"
#include "scene/unit.clh"

static float largest_of(float3 v) { return fmax(fmax(fabs(v.x), fabs(v.y)), fabs(v.z)); }

kernel void scene_flatten(
    const uint             triangle_count,
    global const uint4*    restrict triangles,  // [triangle_count] three vertices in their order
    global const float4*   restrict positions,  // [given_count] xyz metres
    global float4*         restrict normals)    // [given_count] xyz unit
{
    uint triangle = (uint)get_global_id(0);
    if (triangle >= triangle_count) return;
    uint4 corner = triangles[triangle];
    float3 a = positions[corner.x].xyz;
    float3 b = positions[corner.y].xyz - a;
    float3 c = positions[corner.z].xyz - a;
    // Sides of small triangles too: their product would be too small for a float.
    float side = fmax(largest_of(b), largest_of(c));
    float3 up = (float3)(0.0f, 1.0f, 0.0f);
    float3 normal = side > 0.0f ? scene_unit_or(cross(b / side, c / side), up) : up;
    normals[corner.x] = (float4)(normal, 0.0f);
    normals[corner.y] = (float4)(normal, 0.0f);
    normals[corner.z] = (float4)(normal, 0.0f);
}
