// Texture lookup: kernels/scene/texture.clh in GLSL. Trilinear, in the linear colour space, over the
// scene's own mip levels: OpenGL's samplers round weights to 8 bits and would not agree.
// SPDX-License-Identifier: MIT

// i lies within two periods of 0: GLSL has no remainder of negative numbers.
int texture_wrap(int i, int extent, uint mode) {
    if (mode == 2u) return clamp(i, 0, extent - 1);
    if (mode == 1u) {
        int period = 2 * extent;
        int m = (i + 2 * period) % period;
        return m < extent ? m : period - 1 - m;
    }
    return (i + 2 * extent) % extent;
}

float texture_decode(uint value) { return texelFetch(decode, ivec2(int(value), 0), 0).x; }

vec4 texture_texel(bool linear, uint first, int width, int x, int y) {
    uint texel = texelFetch(texels, data_at(first + uint(y) * uint(width) + uint(x)), 0).x;
    vec4 bytes = vec4(texel & 255u, (texel >> 8) & 255u, (texel >> 16) & 255u, texel >> 24);
    if (linear) return bytes * (1.0 / 255.0);
    return vec4(texture_decode(texel & 255u), texture_decode((texel >> 8) & 255u),
                texture_decode((texel >> 16) & 255u), bytes.w * (1.0 / 255.0));
}

vec4 texture_level(uvec4 record, int level, vec2 uv) {
    bool linear = (record.w & TEXTURE_LINEAR) != 0u;
    uint first = record.x;
    int width = int(record.y);
    int height = int(record.z);
    for (int k = 0; k < level; ++k) {
        first += uint(width) * uint(height);
        width = max(width >> 1, 1);
        height = max(height >> 1, 1);
    }
    uint wrap_s = record.w & TEXTURE_WRAP_S;
    uint wrap_t = (record.w & TEXTURE_WRAP_T) >> 2;
    if (wrap_s != 2u) uv.x -= 2.0 * floor(0.5 * uv.x);
    if (wrap_t != 2u) uv.y -= 2.0 * floor(0.5 * uv.y);
    float x = clamp(uv.x, -2.0, 3.0) * float(width) - 0.5;
    float y = clamp(uv.y, -2.0, 3.0) * float(height) - 0.5;
    if ((record.w & TEXTURE_NEAREST) != 0u)
        return texture_texel(linear, first, width, texture_wrap(int(floor(x + 0.5)), width, wrap_s),
                             texture_wrap(int(floor(y + 0.5)), height, wrap_t));
    float xf = floor(x);
    float yf = floor(y);
    int x0 = texture_wrap(int(xf), width, wrap_s);
    int x1 = texture_wrap(int(xf) + 1, width, wrap_s);
    int y0 = texture_wrap(int(yf), height, wrap_t);
    int y1 = texture_wrap(int(yf) + 1, height, wrap_t);
    vec4 top = mix(texture_texel(linear, first, width, x0, y0),
                   texture_texel(linear, first, width, x1, y0), x - xf);
    vec4 bottom = mix(texture_texel(linear, first, width, x0, y1),
                      texture_texel(linear, first, width, x1, y1), x - xf);
    return mix(top, bottom, y - yf);
}

// Alpha of the finest level, which masks compare.
float texture_sample_alpha(int index, vec2 uv) {
    return texture_level(texelFetch(textures, data_at(uint(index)), 0), 0, uv).w;
}

// area: what one pixel covers of UV space.
vec4 texture_sample(int index, vec2 uv, float area) {
    uvec4 record = texelFetch(textures, data_at(uint(index)), 0);
    int levels = int(record.w >> TEXTURE_LEVELS_SHIFT);
    float count = area * float(record.y) * float(record.z);
    float level = min(0.5 * log2(clamp(count, 1.0, 1e9)), float(levels - 1));
    int lower = int(level);
    vec4 fine = texture_level(record, lower, uv);
    float blend = level - float(lower);
    if (blend == 0.0) return fine;
    return mix(fine, texture_level(record, lower + 1, uv), blend);
}
