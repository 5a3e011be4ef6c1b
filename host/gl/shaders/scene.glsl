// The scene's buffers, each in a texture whose rows are DATA_WIDTH texels long: their layout is that
// of kernels/scene/buffers.clh and include/clgi/shared/scene.h.
// SPDX-License-Identifier: MIT
uniform usampler2D triangles;  // three vertices, material and flags
uniform sampler2D positions;   // local frame
uniform sampler2D normals;
uniform sampler2D uvs;     // two sets
uniform sampler2D colors;  // rgba
uniform sampler2D materials;   // MATERIAL_ROWS texels each
uniform usampler2D textures;   // first texel, width, height, flags
uniform usampler2D texels;     // RGBA8 in one word
uniform sampler2D decode;      // [256] linear value of an sRGB byte
uniform uint scene_flags;      // SCENE_HAS_...

ivec2 data_at(uint index) {
    return ivec2(int(index % uint(DATA_WIDTH)), int(index / uint(DATA_WIDTH)));
}
uvec4 triangle_words(int triangle) { return texelFetch(triangles, data_at(uint(triangle)), 0); }
vec3 vertex_position(uint vertex) { return texelFetch(positions, data_at(vertex), 0).xyz; }
vec4 material_row(uint material, int row) {
    return texelFetch(materials, data_at(material * uint(MATERIAL_ROWS) + uint(row)), 0);
}
