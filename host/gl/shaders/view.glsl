// The view and how it projects: kernels/gbuffer/project.clh in GLSL. Meaning of the members:
// include/clgi/shared/gbuffer.h.
// SPDX-License-Identifier: MIT
uniform vec4 eye;
uniform vec4 right;
uniform vec4 up;
uniform vec4 forward;
uniform vec4 window;
uniform ivec2 size;     // pixels
uniform uint dither;    // of blended surfaces
uniform uint cull;      // 1: triangles of one side are not seen from behind

bool perspective() { return eye.w == 0.0; }

// (x, y, z) along right, up and forward of the view.
vec3 to_view(vec3 position) {
    vec3 p = position - eye.xyz;
    return vec3(dot(right.xyz, p), dot(up.xyz, p), dot(forward.xyz, p));
}

// The point of the image plane behind the centre of a fragment.
vec2 plane_point(vec2 fragment) {
    float column = floor(fragment.x);
    float row = float(size.y - 1) - floor(fragment.y);
    float x = (column + 0.5) * (2.0 / float(size.x)) - 1.0;
    float y = 1.0 - (row + 0.5) * (2.0 / float(size.y));
    return vec2(x * right.w + window.x, y * up.w + window.y);
}
