// The surface behind a pixel: kernels/gbuffer/surface.clh in GLSL. The pixel's ray is met with the
// plane of its triangle, with barycentrics clamped to the triangle.
// SPDX-License-Identifier: MIT
struct Surface {
    vec3 position;   // local frame
    vec3 normal;     // unit, towards the viewer
    vec3 geometric;  // unit, towards the viewer
    vec3 albedo;
    vec3 emission;  // exposed
    float depth;    // along the view's axis
    float alpha;    // that masks compare
};

vec2 slot_uv(int uv_set, vec4 u_row, vec4 v_row, vec4 uv) {
    vec2 st = uv_set == 0 ? uv.xy : uv.zw;
    return vec2(u_row.x * st.x + (u_row.y * st.y + u_row.z),
                v_row.x * st.x + (v_row.y * st.y + v_row.z));
}

vec4 slot_texture(int index, int uv_set, vec4 u_row, vec4 v_row, vec4 uv, vec2 area) {
    vec2 at = slot_uv(uv_set, u_row, v_row, uv);
    float stretch = abs(u_row.x * v_row.y - u_row.y * v_row.x);
    return texture_sample(index, at, (uv_set == 0 ? area.x : area.y) * stretch);
}

// at: the point on the view's image plane.
Surface surface_at(vec2 at, int triangle) {
    Surface result;
    uvec4 words = triangle_words(triangle);
    uint material = words.w & TRIANGLE_MATERIAL;
    vec3 corner = vertex_position(words.x);
    vec3 e1 = vertex_position(words.y) - corner;
    vec3 e2 = vertex_position(words.z) - corner;

    // The ray: from the eye when perspective, along the axis when orthographic.
    vec3 sideways = at.x * right.xyz + at.y * up.xyz;
    vec3 direction = perspective() ? forward.xyz + sideways : forward.xyz;
    vec3 away = perspective() ? eye.xyz - corner : eye.xyz + sideways - corner;
    vec3 across = cross(e1, e2);
    float determinant = -dot(direction, across);
    float scale = determinant != 0.0 ? 1.0 / determinant : 0.0;
    vec3 c = cross(direction, away);
    float b1 = clamp(-dot(e2, c) * scale, 0.0, 1.0);
    float b2 = clamp(dot(e1, c) * scale, 0.0, 1.0 - b1);
    float b0 = 1.0 - b1 - b2;
    result.position = corner + (b1 * e1 + b2 * e2);

    float twice_area = length(across);
    float toward = determinant > 0.0 ? 1.0 : -1.0;
    result.geometric = twice_area > 0.0 ? across * (toward / twice_area) : vec3(0.0);
    vec3 shading = (b0 * texelFetch(normals, data_at(words.x), 0).xyz +
                    b1 * texelFetch(normals, data_at(words.y), 0).xyz +
                    b2 * texelFetch(normals, data_at(words.z), 0).xyz) * toward;
    float shading_length = length(shading);
    bool facing = shading_length > 0.0 && dot(shading, direction) < 0.0;
    result.normal = facing ? shading / shading_length : result.geometric;

    result.depth = dot(result.position - eye.xyz, forward.xyz);
    // What the pixel covers of the plane.
    float pixel = 4.0 * right.w * up.w / (float(size.x) * float(size.y));
    if (window.w > 0.0) pixel *= window.w;
    float reach = perspective() ? result.depth * result.depth : 1.0;
    float slant = abs(determinant);
    float footprint = slant > 0.0 ? pixel * reach * twice_area / slant : 0.0;

    // Base colour: factor, vertex colour, texture.
    vec4 base = material_row(material, MATERIAL_BASE);
    vec3 emission = (scene_flags & SCENE_HAS_EMISSION) != 0u
                        ? material_row(material, MATERIAL_EMISSION).xyz
                        : vec3(0.0);
    if ((scene_flags & SCENE_HAS_COLORS) != 0u)
        base *= b0 * texelFetch(colors, data_at(words.x), 0) +
                (b1 * texelFetch(colors, data_at(words.y), 0) +
                 b2 * texelFetch(colors, data_at(words.z), 0));
    result.alpha = base.w;
    if ((scene_flags & SCENE_HAS_TEXTURES) != 0u && (scene_flags & SCENE_HAS_UVS) != 0u) {
        vec4 u0 = texelFetch(uvs, data_at(words.x), 0);
        vec4 u1 = texelFetch(uvs, data_at(words.y), 0);
        vec4 u2 = texelFetch(uvs, data_at(words.z), 0);
        vec4 uv = b0 * u0 + (b1 * u1 + b2 * u2);
        vec4 f = u1 - u0;
        vec4 g = u2 - u0;
        vec2 uv_area = abs(vec2(f.x * g.y - g.x * f.y, f.z * g.w - g.z * f.w));
        vec2 area = twice_area > 0.0 ? uv_area * footprint / twice_area : vec2(0.0);
        ivec4 slots = floatBitsToInt(material_row(material, MATERIAL_TEXTURES));
        if (slots.x >= 0) {
            vec4 u_row = material_row(material, MATERIAL_BASE_UV);
            vec4 v_row = material_row(material, MATERIAL_BASE_UV + 1);
            base *= slot_texture(slots.x, slots.y & 1, u_row, v_row, uv, area);
            result.alpha *= texture_sample_alpha(slots.x, slot_uv(slots.y & 1, u_row, v_row, uv));
        }
        if (slots.z >= 0 && (scene_flags & SCENE_HAS_EMISSION) != 0u)
            emission *=
                slot_texture(slots.z, slots.w & 1, material_row(material, MATERIAL_EMISSION_UV),
                             material_row(material, MATERIAL_EMISSION_UV + 1), uv, area).xyz;
    }
    result.albedo = base.xyz;
    result.emission = emission;
    return result;
}
