// The nearest triangle of every pixel. Depth is closeness as in include/clgi/shared/gbuffer.h, times
// the near depth when perspective: in [0,1], larger is nearer, as precise far away as near.
// SPDX-License-Identifier: MIT
in float depth;
out int visible;

void main() {
    uvec4 words = triangle_words(gl_PrimitiveID);
    if (cull != 0u && !gl_FrontFacing && (words.w & TRIANGLE_DOUBLE_SIDED) == 0u) discard;
    if ((words.w & TRIANGLE_MASKED) != 0u) {
        float cutoff = material_row(words.w & TRIANGLE_MATERIAL, MATERIAL_EMISSION).w;
        if (!(surface_at(plane_point(gl_FragCoord.xy), gl_PrimitiveID).alpha >= cutoff)) discard;
    }
    // gl_FragCoord.w is 1/z, interpolated along the screen.
    gl_FragDepth = perspective() ? forward.w * gl_FragCoord.w
                                 : max((window.z - depth) / (window.z - forward.w), 1e-7);
    visible = gl_PrimitiveID;
}
