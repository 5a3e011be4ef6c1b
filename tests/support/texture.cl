// Textures looked up at a list of places.
// SPDX-License-Identifier: MIT
#include "scene/texture.clh"

kernel void sample_textures(
    global const TextureRecord*  restrict textures,
    global const uint*           restrict texels,
    global const float*          restrict decode,  // [256]
    global const float4*         restrict places,  // [items] u, v, area of UV space; w: texture
    global float4*               restrict colors)  // [items]
{
    float4 at = places[get_global_id(0)];
    colors[get_global_id(0)] =
        texture_sample(textures, texels, decode, (int)at.w, at.x, at.y, at.z);
}

// The alpha that masks compare.
kernel void sample_alphas(
    global const TextureRecord*  restrict textures,
    global const uint*           restrict texels,
    global const float4*         restrict places,  // as above
    global float*                restrict alphas)  // [items]
{
    float4 at = places[get_global_id(0)];
    alphas[get_global_id(0)] =
        texture_sample_alpha(textures, texels, (int)at.w, at.x, at.y);
}
