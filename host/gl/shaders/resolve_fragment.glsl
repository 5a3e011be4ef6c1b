// Attributes of the visible triangles, in world units: metres from the local frame's origin, cd/m^2.
// SPDX-License-Identifier: MIT
uniform isampler2D visibility;
uniform float metre;     // local units in a metre
uniform float exposure;  // radiance of 1 on the device, cd/m^2

layout(location = 0) out vec4 position;
layout(location = 1) out vec4 normal;
layout(location = 2) out vec4 geometric;
layout(location = 3) out vec4 albedo;
layout(location = 4) out vec4 emission;
layout(location = 5) out float depth;
layout(location = 6) out ivec2 ids;

void main() {
    int triangle = texelFetch(visibility, ivec2(gl_FragCoord.xy), 0).x;
    position = normal = geometric = albedo = emission = vec4(0.0);
    depth = 0.0;
    ids = ivec2(-1);
    if (triangle < 0) return;
    Surface surface = surface_at(plane_point(gl_FragCoord.xy), triangle);
    position = vec4(surface.position / metre, 1.0);
    normal = vec4(surface.normal, 0.0);
    geometric = vec4(surface.geometric, 0.0);
    albedo = vec4(surface.albedo, surface.alpha);
    emission = vec4(surface.emission * exposure, 0.0);
    depth = surface.depth / metre;
    ids = ivec2(int(triangle_words(triangle).w & TRIANGLE_MATERIAL), triangle);
}
