// The box around every cluster of triangles, the cone of their normals, spheres and boxes around
// its parts, and the parts' corners.
// [derived: minima and maxima are exact, so the boxes are those of the host at load, bit for bit]
//
// Work size    1D, one work-item a cluster; any local size; tail guarded
// Writes       its own cluster and the parts of it
// SPDX-License-Identifier: MIT
#include "clgi/shared/scene.h"

#define LEAST_COSINE 0.1f  // a wider cone is hardly ever seen from behind as a whole

static float sum_of_squares(float3 v) { return (v.x * v.x + v.y * v.y) + v.z * v.z; }

static float3 normal_of(uint4 corner, global const float4* positions) {
    float3 a = positions[corner.x].xyz;
    float3 b = positions[corner.y].xyz - a;
    float3 c = positions[corner.z].xyz - a;
    return (float3)(b.y * c.z - c.y * b.z, b.z * c.x - c.z * b.x, b.x * c.y - c.x * b.y);
}

static float4 cone_of(global const uint4* triangles, global const float4* positions, uint first,
                      uint last) {
    float4 none = (float4)(0.0f, 0.0f, 0.0f, 2.0f);
    float3 axis = (float3)(0.0f);
    for (uint t = first; t < last; ++t) {
        if (triangles[t].w & (uint)TRIANGLE_DOUBLE_SIDED) return none;
        float3 n = normal_of(triangles[t], positions);
        float size = sqrt(sum_of_squares(n));
        if (size > 0.0f) axis += n / size;
    }
    float whole = sqrt(sum_of_squares(axis));
    if (!(whole > 0.0f)) return none;
    axis /= whole;
    float cosine = 1.0f;
    for (uint t = first; t < last; ++t) {
        float3 n = normal_of(triangles[t], positions);
        float size = sqrt(sum_of_squares(n));
        float along = (n.x * axis.x + n.y * axis.y) + n.z * axis.z;
        if (size > 0.0f) cosine = min(cosine, along / size);
    }
    if (!(cosine > LEAST_COSINE)) return none;
    return (float4)(axis, sqrt(1.0f - cosine * cosine));
}

// Triangles first .. last - 1, or none.
static void set_part(global const uint4* triangles, global const float4* positions, uint first,
                     uint last, global Cluster* cluster, int part) {
    float3 middle = (float3)(0.0f), low = (float3)(0.0f), high = (float3)(0.0f);
    float radius = 0.0f;
    if (first < last) {
        low = high = positions[triangles[first].x].xyz;
        for (uint t = first; t < last; ++t) {
            uint4 corner = triangles[t];
            float3 p[3] = {positions[corner.x].xyz, positions[corner.y].xyz,
                           positions[corner.z].xyz};
            for (int k = 0; k < 3; ++k) {
                low = select(low, p[k], p[k] < low);
                high = select(high, p[k], p[k] > high);
            }
        }
        middle = 0.5f * (low + high);
        float square = 0.0f;
        for (uint t = first; t < last; ++t) {
            uint4 corner = triangles[t];
            square = max(square, max(sum_of_squares(positions[corner.x].xyz - middle),
                                     max(sum_of_squares(positions[corner.y].xyz - middle),
                                         sum_of_squares(positions[corner.z].xyz - middle))));
        }
        radius = sqrt(square);
    }
    cluster->part[0][part] = middle.x;
    cluster->part[1][part] = middle.y;
    cluster->part[2][part] = middle.z;
    cluster->part[3][part] = radius;
    cluster->part_low[0][part] = low.x;
    cluster->part_low[1][part] = low.y;
    cluster->part_low[2][part] = low.z;
    cluster->part_high[0][part] = high.x;
    cluster->part_high[1][part] = high.y;
    cluster->part_high[2][part] = high.z;
}

// Corners of triangles first .. first + PART_TRIANGLES - 1; past the last one, its own.
static void set_corners(global const uint4* triangles, global const float4* positions, uint first,
                        uint triangle_count, global PartCorners* part) {
    for (uint k = 0; k < PART_TRIANGLES; ++k) {
        uint4 corner = triangles[min(first + k, triangle_count - 1)];
        float4 p[3] = {positions[corner.x], positions[corner.y], positions[corner.z]};
        for (int c = 0; c < 3; ++c) {
            part->corner[c][0][k] = p[c].x;
            part->corner[c][1][k] = p[c].y;
            part->corner[c][2][k] = p[c].z;
        }
        part->word[k] = corner.w;
    }
}

kernel void scene_clusters(
    const uint             triangle_count,
    global const uint4*    restrict triangles,  // [triangle_count] three vertices, material
    global const float4*   restrict positions,  // [vertex_count] local frame
    global Cluster*        restrict clusters,   // [triangle_count / CLUSTER_TRIANGLES, rounded up]
    global PartCorners*    restrict parts)      // [clusters][CLUSTER_PARTS]
{
    uint cluster = (uint)get_global_id(0);
    uint first = cluster * CLUSTER_TRIANGLES;
    if (first >= triangle_count) return;
    uint last = min(first + CLUSTER_TRIANGLES, triangle_count);

    float4 low = positions[triangles[first].x];
    float4 high = low;
    for (uint t = first; t < last; ++t) {
        uint4 corner = triangles[t];
        float4 p[3] = {positions[corner.x], positions[corner.y], positions[corner.z]};
        for (int k = 0; k < 3; ++k) {
            // Of 0 and -0 the first one stays, here and on the host: min() may choose.
            low = select(low, p[k], p[k] < low);
            high = select(high, p[k], p[k] > high);
        }
    }
    clusters[cluster].low = (float4)(low.xyz, 0.0f);
    clusters[cluster].high = (float4)(high.xyz, 0.0f);
    clusters[cluster].cone = cone_of(triangles, positions, first, last);
    for (uint part = 0; part < CLUSTER_PARTS; ++part) {
        uint begin = min(first + part * PART_TRIANGLES, last);
        set_part(triangles, positions, begin, min(begin + PART_TRIANGLES, last),
                 clusters + cluster, (int)part);
        set_corners(triangles, positions, first + part * PART_TRIANGLES, triangle_count,
                    parts + cluster * CLUSTER_PARTS + part);
    }
}
