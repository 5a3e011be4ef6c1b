// Patches that moved: where their triangles' vertices put them now.
//                                   [Dachsbacher07, section 3.3; derived: as the host places them]
//
// All patches of a triangle get the same normal, from its whole edges: those of small parts would
// have fewer bits. A triangle whose normal floats cannot tell has none for now, and no area: it
// sends nothing, and nothing arrives that it could use.
//
// Work size    1D, one work-item a patch of the list; any local size; tail guarded
// Writes       the place of its patch; of leaves normal and area of the element
// Cost         CLGI_BINS dot products
// SPDX-License-Identifier: MIT
#include "clgi/shared/antiradiance.h"
#include "clgi/shared/moving_elements.h"
#include "antiradiance/triangle.clh"

#ifndef CLGI_BINS
#define CLGI_BINS 128
#endif

// What the cosines of a hemisphere of bins must be multiplied by to add up to pi.
CLGI_INLINE float hemisphere_scale(float3 normal, global const float4* directions) {
    float sum = 0.0f;
    for (uint bin = 0; bin < CLGI_BINS; ++bin) {
        float4 w = directions[bin];
        sum = fma(w.w, fmax(dot(normal, w.xyz), 0.0f), sum);
    }
    return CLGI_PI / sum;
}

kernel void antiradiance_refit(
    const ElementParams          params,
    global const uint*           restrict list,        // patches, elements
    global const PatchCorners*   restrict patches,     // [elements]
    global const uint4*          restrict triangles,   // of the scene
    global const float4*         restrict positions,   // of its vertices, local frame
    global const float4*         restrict directions,  // [CLGI_BINS] unit; w: sr
    global ElementPlace*         restrict places,      // [elements]
    global Element*              restrict elements)    // [elements]
{
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    PatchCorners patch = patches[element];
    Triangle whole = triangle_of(triangles[places[element].triangle], positions);
    float share = signed_share(patch);
    float3 across = cross(whole.edge1, whole.edge2);
    float twice = length(across);

    float4 normal = (float4)(0.0f);
    float area = 0.0f;
    if (!is_thin(whole, twice)) {
        normal.xyz = across * ((share < 0.0f ? -1.0f : 1.0f) / twice);
        normal.w = hemisphere_scale(normal.xyz, directions);
        area = 0.5f * twice * fabs(share);
    }
    float2 middle = (patch.weights.xy + patch.weights.zw + patch.last.xy) * (1.0f / 3.0f);
    places[element].position.xyz = point_at(whole, middle);
    places[element].normal = normal;
    places[element].area = area;
    if (elements[element].end == element + 1)
        elements[element].normal = (float4)(normal.xyz * normal.w, area);
}
