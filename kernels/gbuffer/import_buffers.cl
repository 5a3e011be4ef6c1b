// Planes of a G-buffer from buffers of texels: textures of another renderer, copied.
// [derived: clgi/shared/gbuffer.h says what planes hold; import.clh brings texels there]
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       its own pixels of all planes; past the last pixel of the view, inside the stride,
//              zeros; non_finite counts the pixels that were not finite
// SPDX-License-Identifier: MIT
#include "gbuffer/import.clh"

CLGI_INLINE float4 import_fetch(global const uchar* texels, uint format, uint index) {
    if (format == TEXEL_RGBA32F) return vload4(index, (global const float*)texels);
    if (format == TEXEL_RGBA16F) return vload_half4(index, (global const half*)texels);
    return convert_float4(vload4(index, texels)) / 255.0f;
}

// Buffers that the flags leave out are never read; any buffer may stand in for them.
kernel void gbuffer_import_buffers(
    const View            view,
    const ImportParams    params,
    global const float*   restrict position,    // [height][width][4] metres
    global const uchar*   restrict normal,      // [height][width] normal_format
    global const uchar*   restrict geometric,   // [height][width] geometric_format
    global const uchar*   restrict albedo,      // [height][width] albedo_format, linear
    global const uchar*   restrict emission,    // [height][width] emission_format, cd/m^2
    global const float*   restrict depth,       // [height][width] metres along the view's axis
    global const int*     restrict labels,      // [height][width][1, or 2 with IMPORT_TRIANGLE]
    global float*         restrict planes,      // [GBUFFER_PLANES][stride]
    global int*           restrict ids,         // [GBUFFER_ID_PLANES][stride]
    volatile global uint* restrict non_finite)  // [1]
{
    uint pixel = (uint)get_global_id(0) * CLGI_WIDTH;
    uint pixels = view.width * view.height;
    if (pixel >= pixels) return;

    ImportTexels texels;
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        import_nothing(&texels, k);
        if (pixel + k >= pixels) continue;
        int2 at = import_texel(&view, params.flags, pixel + k);
        uint index = (uint)at.y * view.width + (uint)at.x;
        texels.normal[k] = import_fetch(normal, params.normal_format, index);
        texels.albedo[k] = import_fetch(albedo, params.albedo_format, index);
        if (params.flags & IMPORT_POSITION) texels.position[k] = vload4(index, position);
        if (params.flags & IMPORT_GEOMETRIC)
            texels.geometric[k] = import_fetch(geometric, params.geometric_format, index);
        if (params.flags & IMPORT_EMISSION)
            texels.emission[k] = import_fetch(emission, params.emission_format, index);
        if (params.flags & IMPORT_DEPTH) texels.depth[k] = depth[index];
        if (params.flags & IMPORT_TRIANGLE) {
            texels.material[k] = labels[2 * index];
            texels.triangle[k] = labels[2 * index + 1];
        } else if (params.flags & IMPORT_MATERIAL) {
            texels.material[k] = labels[index];
        }
    }
    import_store(&view, &params, &texels, pixel, planes, ids, non_finite);
}
