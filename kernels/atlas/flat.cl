// Which blocks of texels are flat: those whose corners can stand for them.
//
// All texels and corners of a flat block lie in the plane of its first texel, and face as it does.
// [derived: the discontinuities of Cochran07, section 3.2, between texels; Schaerfig16, section 6.2]
//
// Work size     1D, one work-item for every block; any local size; tail guarded
// Writes        AtlasBlock::flat of its own block
// Cost          BLOCK_TEXELS + 9 texels read at most
// SPDX-License-Identifier: MIT
#include "clgi/shared/atlas.h"
#include "clgi/shared/gbuffer.h"

#define FLAT_OFF 0.03125f  // beside the plane at most, of the block's diagonal
#define FLAT_ALIKE 0.98f   // cosine between normals at least

CLGI_INLINE float3 flat_load(global const float* plane, uint stride, uint texel) {
    return (float3)(plane[texel], plane[stride + texel], plane[2 * stride + texel]);
}

// Whether a point lies in the plane of an origin and its normal, and faces as that does.
CLGI_INLINE int flat_there(global const float* planes, uint stride, uint at, float3 origin,
                           float3 normal, float off) {
    float3 place = flat_load(planes, stride, at);
    float3 faces = flat_load(planes + GBUFFER_GEOMETRIC * stride, stride, at);
    return fabs(dot(place - origin, normal)) <= off && dot(faces, normal) >= FLAT_ALIKE;
}

kernel void atlas_flat(
    const BlockParams   params,
    global const float* restrict texels,  // [>= GBUFFER_GEOMETRIC + 3][stride]
    global const float* restrict listed,  // [>= GBUFFER_GEOMETRIC + 3][listed_stride]
    global AtlasBlock*  restrict blocks)  // [block_count]
{
    uint id = (uint)get_global_id(0);
    if (id >= params.block_count) return;
    global AtlasBlock* block = blocks + id;
    uint stride = params.stride;
    float3 origin = flat_load(texels, stride, block->row[0]);
    float3 normal = flat_load(texels + GBUFFER_GEOMETRIC * stride, stride, block->row[0]);
    float off = FLAT_OFF * length(flat_load(texels, stride, block->row[3] + 3) - origin);
    uint flat = 1;
    for (uint k = 0; k < BLOCK_TEXELS; ++k)
        flat &= flat_there(texels, stride, block->row[k / 4] + k % 4, origin, normal, off);
    for (uint k = 0; k < block->corners; ++k)
        flat &= flat_there(listed, params.listed_stride, block->corner[k], origin, normal, off);
    block->flat = flat;
}
