// Fall-offs of lights at a list of angles and distances.
// SPDX-License-Identifier: MIT
#include "lights/falloff.clh"

kernel void sample_falloffs(
    global const float4*  restrict cones,   // [items] cosine, cos outer, cos inner; w: distance
    global const float*   restrict ranges,  // [items]
    global float2*        restrict shares)  // [items] of the cone, of the range
{
    size_t i = get_global_id(0);
    shares[i] = (float2)(cone_falloff_one(cones[i].x, cones[i].y, cones[i].z),
                         range_falloff_one(cones[i].w, ranges[i]));
}
