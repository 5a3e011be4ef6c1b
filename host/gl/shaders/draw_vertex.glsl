// Corners of triangles, fetched by number and rounded to 1/256 pixel as kernels/gbuffer/transform.cl
// rounds them, so that both rasterisers see the same edges.
// SPDX-License-Identifier: MIT
out float depth;  // along the view's axis

void main() {
    uvec4 words = triangle_words(gl_VertexID / 3);
    int corner = gl_VertexID % 3;
    vec3 p = to_view(vertex_position(corner == 0 ? words.x : corner == 1 ? words.y : words.z));
    float w = perspective() ? p.z : 1.0;
    depth = p.z;
    gl_ClipDistance[0] = p.z - forward.w;

    vec2 pixels = vec2(size);
    vec2 extent = vec2(right.w, up.w);
    vec2 guard = 2.0 * float(GUARD_PIXELS) / pixels - 1.0;
    vec2 at = ((perspective() ? p.xy / p.z : p.xy) - window.xy) / extent;
    vec2 clip = (p.xy - window.xy * w) / extent;  // what leaves the view is clipped unrounded
    if (p.z >= forward.w && all(lessThanEqual(abs(at), guard))) {
        vec2 raised = (at * vec2(0.5, -0.5) + 0.5) * pixels * float(SUBPIXELS) + 0.5;
        vec2 rounded = floor(raised) / float(SUBPIXELS) / pixels;
        clip = vec2(2.0 * rounded.x - 1.0, 1.0 - 2.0 * rounded.y) * w;
    }
    // Depth is written by the fragment; near is cut by the clip distance.
    gl_Position = vec4(clip, 0.0, w);
}
