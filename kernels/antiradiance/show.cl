// What arrives at the pixels of a picture: of the leaf that is seen, interpolated between its corners.
//                                               [Dachsbacher07, section 4.3; derived: the descent]
//
// From the patch of the whole triangle down, the part whose smallest weight at the point is largest
// holds it. A patch that is no element has leaves at its corners.
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       its own pixel, 0 where no element is. Less than nothing, which an expansion into bins
//              may give where little arrives, is 0; what is not finite stays so, for the passes that
//              count it
// SPDX-License-Identifier: MIT
#include "clgi/shared/antiradiance.h"
#include "clgi/shared/gbuffer.h"
#include "gbuffer/seen.clh"
#include "planes.clh"

// Weights of a patch's corners at a point of its triangle, which has weights of its own.
CLGI_INLINE float3 weights_in(PatchCorners patch, float2 at) {
    float2 first = patch.weights.xy, edge1 = patch.weights.zw - first,
           edge2 = patch.last.xy - first, to = at - first;
    float area = edge1.x * edge2.y - edge1.y * edge2.x;
    float b1 = (to.x * edge2.y - to.y * edge2.x) / area;
    float b2 = (edge1.x * to.y - edge1.y * to.x) / area;
    return (float3)(1.0f - b1 - b2, b1, b2);
}

CLGI_INLINE float smallest(float3 weights) { return fmin(fmin(weights.x, weights.y), weights.z); }

kernel void antiradiance_show(
    const ShowElementsParams      params,
    global const uint4*           restrict triangles,  // [triangle_count] of the scene
    global const float4*          restrict positions,  // of its vertices, local frame
    global const TrianglePatches* restrict roots,      // [triangle_count]
    global const Element*         restrict elements,
    global const PatchCorners*    restrict patches,    // [elements], then of other triangles
    global const float*           restrict planes,     // [GBUFFER_PLANES][pixel_stride]
    global const int*             restrict ids,        // [GBUFFER_ID_PLANES][pixel_stride]
    global const float4*          restrict light,      // [vertices] rgb
    global float*                 restrict shown)      // [3][pixel_stride]
{
    uint pixel = (uint)get_global_id(0);
    if (pixel >= params.pixel_count) return;
    uint stride = params.pixel_stride;
    float sum[3] = {0.0f, 0.0f, 0.0f};
    int triangle = seen_triangle(ids, stride, pixel, params.triangle_count);
    if (triangle >= 0) {
        Seen seen = seen_at(params.eye, triangles[triangle], positions, planes, stride, pixel);
        float2 at = seen.weights;
        TrianglePatches root = roots[triangle];
        uint element = seen.back && root.back != ELEMENT_NONE ? root.back : root.front;
        if (element != ELEMENT_NONE) {
            while (element < params.element_count && elements[element].end != element + 1) {
                uint end = elements[element].end, inside = element + 1;
                float best = -FLT_MAX;
                for (uint part = element + 1; part < end; part = elements[part].end) {
                    float least = smallest(weights_in(patches[part], at));
                    if (least > best) {
                        best = least;
                        inside = part;
                    }
                }
                element = inside;
            }
            float3 weights = weights_in(patches[element], at);
            weights = fmax(weights, (float3)(0.0f));
            weights /= weights.x + weights.y + weights.z;
            float4 found = weights.x * light[patches[element].vertex[0]] +
                           weights.y * light[patches[element].vertex[1]] +
                           weights.z * light[patches[element].vertex[2]];
            float channel[3] = {found.x, found.y, found.z};
            for (int c = 0; c < 3; ++c) sum[c] = channel[c] < 0.0f ? 0.0f : channel[c];
        }
    }
    for (int c = 0; c < 3; ++c) row_store_one(sum[c], irradiance_row(shown, c, stride), pixel);
}
