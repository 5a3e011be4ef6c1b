// Clusters of one level that moved: the mean place of the elements right below, which are done,
// weighted by area, and the sum of their areas.
//                                  [Dachsbacher07, sections 3.2 and 3.3; derived: as the host has it]
//
// Work size    1D, one work-item a cluster of the list; any local size; tail guarded
// Writes       position and area of its cluster's place
// SPDX-License-Identifier: MIT
#include "clgi/shared/antiradiance.h"
#include "clgi/shared/moving_elements.h"

kernel void antiradiance_refit_clusters(
    const ElementParams    params,
    global const uint*     restrict list,      // clusters, elements
    global const Element*  restrict elements,
    global ElementPlace*   restrict places)    // [elements]
{
    uint at = (uint)get_global_id(0);
    if (at >= params.count) return;
    uint element = list[params.first + at];
    uint end = elements[element].end, count = 0;
    float3 sum = (float3)(0.0f), plain = (float3)(0.0f);
    float area = 0.0f;
    for (uint below = element + 1; below < end; below = elements[below].end) {
        ElementPlace place = places[below];
        sum = fma((float3)(place.area), place.position.xyz, sum);
        plain += place.position.xyz;
        area += place.area;
        ++count;
    }
    // Where all have collapsed it is in their middle.
    places[element].position.xyz = area > 0.0f ? sum / area : plain / (float)count;
    places[element].area = area;
}
