// Planes of a G-buffer from images: textures of another renderer, shared without a copy.
// [derived: clgi/shared/gbuffer.h says what planes hold; import.clh brings texels there]
//
// Work size    1D, one work-item for every CLGI_WIDTH pixels (rounded up); any local size
// Writes       its own pixels of all planes; past the last pixel of the view, inside the stride,
//              zeros; non_finite counts the pixels that were not finite
// SPDX-License-Identifier: MIT
#include "gbuffer/import.clh"

// Images that the flags leave out are never read; any image may stand in for them.
kernel void gbuffer_import_images(
    const View            view,
    const ImportParams    params,
    read_only image2d_t   position,   // RGBA32F, metres
    read_only image2d_t   normal,
    read_only image2d_t   geometric,
    read_only image2d_t   albedo,     // linear
    read_only image2d_t   emission,   // cd/m^2
    read_only image2d_t   depth,      // R32F, metres along the view's axis
    read_only image2d_t   labels,     // R32I material, or RG32I material and triangle
    global float*         restrict planes,      // [GBUFFER_PLANES][stride]
    global int*           restrict ids,         // [GBUFFER_ID_PLANES][stride]
    volatile global uint* restrict non_finite)  // [1]
{
    const sampler_t texel =
        CLK_NORMALIZED_COORDS_FALSE | CLK_ADDRESS_CLAMP_TO_EDGE | CLK_FILTER_NEAREST;
    uint pixel = (uint)get_global_id(0) * CLGI_WIDTH;
    uint pixels = view.width * view.height;
    if (pixel >= pixels) return;

    ImportTexels texels;
    for (uint k = 0; k < CLGI_WIDTH; ++k) {
        import_nothing(&texels, k);
        if (pixel + k >= pixels) continue;
        int2 at = import_texel(&view, params.flags, pixel + k);
        texels.normal[k] = read_imagef(normal, texel, at);
        texels.albedo[k] = read_imagef(albedo, texel, at);
        if (params.flags & IMPORT_POSITION) texels.position[k] = read_imagef(position, texel, at);
        if (params.flags & IMPORT_GEOMETRIC)
            texels.geometric[k] = read_imagef(geometric, texel, at);
        if (params.flags & IMPORT_EMISSION) texels.emission[k] = read_imagef(emission, texel, at);
        if (params.flags & IMPORT_DEPTH) texels.depth[k] = read_imagef(depth, texel, at).x;
        if (params.flags & IMPORT_MATERIAL) {
            int4 label = read_imagei(labels, texel, at);
            texels.material[k] = label.x;
            texels.triangle[k] = label.y;
        }
    }
    import_store(&view, &params, &texels, pixel, planes, ids, non_finite);
}
