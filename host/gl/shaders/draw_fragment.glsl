// The nearest triangle of every pixel. Depth is closeness as in include/clgi/shared/gbuffer.h, times
// the near depth when perspective: in [0,1], larger is nearer, as precise far away as near.
// SPDX-License-Identifier: MIT
in float depth;
out int visible;

uint stirred(uint h) {
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    return h ^ (h >> 16);
}

// tile_chance of kernels/gbuffer/tile.clh.
float chance() {
    uint row = uint(size.y - 1) - uint(gl_FragCoord.y);
    uint words[] = uint[](uint(gl_PrimitiveID), dither,
                          floatBitsToUint(window.x), floatBitsToUint(window.y),
                          floatBitsToUint(eye.x), floatBitsToUint(eye.y), floatBitsToUint(eye.z),
                          floatBitsToUint(forward.x), floatBitsToUint(forward.y),
                          floatBitsToUint(forward.z), row);
    uint key = 0u;
    for (int k = 0; k < 11; ++k) key = stirred(key + words[k]);
    return (float(stirred(uint(gl_FragCoord.x) + key) >> 8) + 0.5) * (1.0 / 16777216.0);
}

void main() {
    uvec4 words = triangle_words(gl_PrimitiveID);
    if (cull != 0u && !gl_FrontFacing && (words.w & TRIANGLE_DOUBLE_SIDED) == 0u) discard;
    if ((words.w & TRIANGLE_MASKED) != 0u) {
        float cutoff = material_row(words.w & TRIANGLE_MATERIAL, MATERIAL_EMISSION).w;
        if (cutoff == ALPHA_BLENDED) cutoff = chance();
        if (!(surface_at(plane_point(gl_FragCoord.xy), gl_PrimitiveID).alpha >= cutoff)) discard;
    }
    // gl_FragCoord.w is 1/z, interpolated along the screen.
    gl_FragDepth = perspective() ? forward.w * gl_FragCoord.w
                                 : max((window.z - depth) / (window.z - forward.w), 1e-7);
    visible = gl_PrimitiveID;
}
