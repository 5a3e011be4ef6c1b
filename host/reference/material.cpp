// SPDX-License-Identifier: MIT
#include "reference/material.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace clgi::reference {
namespace {

// An attribute of the three corners, weighed.
template <typename T>
T between(const std::vector<T>& values, const Geometry& geometry, const Hit& hit) {
    const SceneTriangle& triangle = geometry.triangles[hit.triangle];
    return values[triangle.vertex[0]] * (1.0f - hit.b1 - hit.b2) +
           values[triangle.vertex[1]] * hit.b1 + values[triangle.vertex[2]] * hit.b2;
}

glm::vec4 textured(const Geometry& geometry, const TextureSlot& slot, const Hit& hit) {
    if (slot.texture < 0 || geometry.uvs.empty()) return glm::vec4(1.0f);
    const glm::vec4 both = between(geometry.uvs, geometry, hit);
    const glm::vec2 uv = slot.uv_set == 0 ? glm::vec2(both.x, both.y) : glm::vec2(both.z, both.w);
    return texel(geometry.textures[static_cast<std::size_t>(slot.texture)],
                 glm::vec2(slot.transform * glm::vec3(uv, 1.0f)));
}

// Textures go on beside the triangle, vertex colours end with it.
glm::vec4 base(const Geometry& geometry, const Hit& hit, const Hit& texture_at) {
    const Material& material = geometry.materials[geometry.triangles[hit.triangle].material];
    glm::vec4 color = material.base_color * textured(geometry, material.base_texture, texture_at);
    if (!geometry.colors.empty()) color *= between(geometry.colors, geometry, hit);
    return color;
}

}  // namespace

Gloss gloss(float metallic, float roughness) {
    const float a = std::max(roughness * roughness, 0.001f);
    Gloss out{};
    out.diffuse = (1.0f - metallic) * (1.0f - 0.04f * (1.0f - a)) + metallic * a;
    out.coat = 0.04f * (1.0f - a) * (1.0f - metallic);
    out.lobe = metallic * (1.0f - a);
    out.exponent = std::min(2.0f / (a * a) - 2.0f, 10000.0f);
    return out;
}

bool opaque(const Geometry& geometry, const Hit& hit) {
    const Material& material = geometry.materials[geometry.triangles[hit.triangle].material];
    return material.alpha_mode != AlphaMode::mask ||
           base(geometry, hit, hit).w >= material.alpha_cutoff;
}

glm::vec3 geometric_normal(const Geometry& geometry, std::uint32_t index) {
    const SceneTriangle& triangle = geometry.triangles[index];
    const glm::dvec3 a(geometry.positions[triangle.vertex[0]]);
    const glm::dvec3 b(geometry.positions[triangle.vertex[1]]);
    const glm::dvec3 c(geometry.positions[triangle.vertex[2]]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    return length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f);
}

Surface surface_at(const Geometry& geometry, const Hit& hit, const glm::vec3& direction,
                   const Hit& texture_at) {
    const Material& material = geometry.materials[geometry.triangles[hit.triangle].material];
    Surface out{};
    out.position = between(geometry.positions, geometry, hit);
    const glm::vec3 wound = geometric_normal(geometry, hit.triangle);
    const bool front = glm::dot(wound, direction) < 0.0f;
    const float side = front ? 1.0f : -1.0f;
    out.geometric = side * wound;
    out.normal = side * between(geometry.normals, geometry, hit);
    const float length = glm::length(out.normal);
    // A shading normal that vanishes or faces away from the viewer gives way to the geometric one.
    out.normal = length > 0.0f && glm::dot(out.normal, direction) < 0.0f ? out.normal / length
                                                                         : out.geometric;
    out.reflects = front || material.double_sided;
    if (!out.reflects) return out;
    const Gloss shares = gloss(material.metallic, material.roughness);
    const glm::vec3 color = glm::vec3(base(geometry, hit, texture_at));
    out.albedo = color * shares.diffuse;
    out.lobe = color * shares.lobe + shares.coat;
    out.exponent = shares.exponent;
    out.emission = material.emission;
    if (luminance(out.emission) > 0.0f)
        out.emission *= glm::vec3(textured(geometry, material.emission_texture, texture_at));
    return out;
}

}  // namespace clgi::reference
