// Places vertices that animation moves: morph targets, then joints.
//
//   rest'    = rest + sum_t weight_t difference_t              also for normals
//   matrix   = sum_j weight_j matrix_j                          weights of a vertex sum to 1
//   position = matrix rest'
//   normal   = sign(det matrix) cof(matrix) rest'_normal, to unit length
//
// [derived: glTF 2.0, sections 3.7.2.2 and 3.7.3.3; cofactors are the inverse transpose times the
// determinant, and are right also where a scale is zero]
// Rest positions are relative to the middle of their range and positions to an origin, so floats
// carry the size of things alone, not their places. A normal without a direction points up.
//
// Cost         Per vertex: 32 B read and 32 B written; for each influence 8 B, a matrix of 48 B
//              that vertices share, and 24 operations; for each target with a weight that is not
//              zero 12 B and 6 operations, twice that where it moves normals.
// Work size    1D, one work-item a posed vertex; any local size; tail guarded
// Writes       its own vertex; of flat ranges no normal
// SPDX-License-Identifier: MIT
#include "clgi/shared/scene.h"
#include "scene/unit.clh"

// Sum of differences, of `rows` from `first` on.
static float3 morphed(float3 value, const PoseRange* range, uint first, uint vertex,
                      global const float* differences, global const float* weights) {
    for (uint t = 0; t < range->targets; ++t) {
        float weight = weights[range->first_weight + t];
        if (weight == 0.0f) continue;
        value += weight * vload3(first + t * range->count + vertex, differences);
    }
    return value;
}

static PoseMatrix blended(const PoseRange* range, uint vertex,
                          global const uint2* influences,
                          global const PoseMatrix* matrices) {
    if (range->influences == 0) return matrices[range->matrix];
    PoseMatrix sum;
    for (int i = 0; i < 3; ++i) sum.row[i] = (float4)(0.0f);
    for (uint i = 0; i < range->influences; ++i) {
        uint2 influence =
            influences[range->first_influence + i * range->count + vertex];
        float weight = as_float(influence.y);
        if (!(weight > 0.0f)) continue;
        PoseMatrix matrix = matrices[range->matrix + influence.x];
        for (int k = 0; k < 3; ++k) sum.row[k] += weight * matrix.row[k];
    }
    return sum;
}

static float3 turned(const PoseMatrix* matrix, float3 normal) {
    float3 x = matrix->row[0].xyz;
    float3 y = matrix->row[1].xyz;
    float3 z = matrix->row[2].xyz;
    // A model in nanometres: products of three of its numbers would be too small for a float.
    float3 most = fmax(fmax(fabs(x), fabs(y)), fabs(z));
    float largest = fmax(fmax(most.x, most.y), most.z);
    if (!(largest > 0.0f)) return (float3)(0.0f);
    x /= largest;
    y /= largest;
    z /= largest;
    float3 yz = cross(y, z);
    float3 out = (float3)(dot(yz, normal), dot(cross(z, x), normal), dot(cross(x, y), normal));
    return dot(x, yz) < 0.0f ? -out : out;
}

kernel void scene_pose(
    const PoseParams              params,
    global const PoseRange*       restrict ranges,          // [range_count]
    global const uint4*           restrict rest_positions,  // [vertex_count] floats: xyz from the
                                                            // range's middle; w: its range
    global const float4*          restrict rest_normals,    // [vertex_count] xyz unit
    global const uint2*           restrict influences,      // [influence_count] joint of the range,
                                                            // bits of its weight; 0: nothing
    global const float*           restrict differences,     // [difference_count][3]
    global const PoseMatrix*      restrict matrices,        // [matrix_count]
    global const float*           restrict weights,         // [weight_count] of morph targets
    global float4*                restrict positions,       // [given_count] xyz metres
    global float4*                restrict normals)         // [given_count] xyz unit
{
    uint vertex = (uint)get_global_id(0);
    if (vertex >= params.vertex_count) return;
    uint4 rest = rest_positions[vertex];
    PoseRange range = ranges[rest.w];
    uint v = vertex - range.first;

    float3 position = (float3)(as_float(rest.x), as_float(rest.y), as_float(rest.z));
    position = morphed(position, &range, range.first_difference, v, differences, weights);
    PoseMatrix matrix = blended(&range, v, influences, matrices);
    positions[range.given + v] =
        (float4)(dot(matrix.row[0].xyz, position) + matrix.row[0].w,
                 dot(matrix.row[1].xyz, position) + matrix.row[1].w,
                 dot(matrix.row[2].xyz, position) + matrix.row[2].w, 0.0f);
    if (range.flags & POSE_FLAT) return;

    float3 up = (float3)(0.0f, 1.0f, 0.0f);
    float3 normal = rest_normals[vertex].xyz;
    if (range.flags & POSE_MORPHS_NORMALS) {
        uint first = range.first_difference + range.targets * range.count;
        normal = scene_unit_or(morphed(normal, &range, first, v, differences, weights),
                               (float3)(0.0f));
    }
    normals[range.given + v] = (float4)(scene_unit_or(turned(&matrix, normal), up), 0.0f);
}
