// What arrives at the pixels of a picture: of the leaf that is seen, interpolated between its corners.
//                                               [Dachsbacher07, section 4.3; derived: the descent]
//
// From the patch of the whole triangle down: of two halves the point lies in that of the corner of the
// cut edge whose weight is the larger one. A patch that is no element has leaves at its corners.
//
// Work size    1D, one work-item a pixel; any local size; tail guarded
// Writes       its own pixel, 0 where no element is. Less than nothing, which an expansion into bins
//              may give where little arrives, is 0; what is not finite stays so, for the passes that
//              count it
// SPDX-License-Identifier: MIT
#include "antiradiance/seen.clh"

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
        SeenLeaf seen = seen_leaf(
            seen_at(params.eye, triangles[triangle], positions, planes, stride, pixel),
            roots[triangle], elements, params.element_count);
        if (seen.element != ELEMENT_NONE) {
            float3 weights = seen.weights;
            uint element = seen.element;
            float4 found = weights.x * light[patches[element].vertex[0]] +
                           weights.y * light[patches[element].vertex[1]] +
                           weights.z * light[patches[element].vertex[2]];
            float channel[3] = {found.x, found.y, found.z};
            for (int c = 0; c < 3; ++c) sum[c] = channel[c] < 0.0f ? 0.0f : channel[c];
        }
    }
    for (int c = 0; c < 3; ++c) row_store_one(sum[c], irradiance_row(shown, c, stride), pixel);
}
