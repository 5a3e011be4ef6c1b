// SPDX-License-Identifier: MIT
#include "reference/material.hpp"

#include <clgi/shared/microfacet.h>
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

// Where a slot reads at texture coordinates of both sets.
glm::dvec2 slot_uv(const TextureSlot& slot, const glm::dvec4& both) {
    const glm::dvec2 uv =
        slot.uv_set == 0 ? glm::dvec2(both.x, both.y) : glm::dvec2(both.z, both.w);
    return glm::dvec2(glm::dmat3(slot.transform) * glm::dvec3(uv, 1.0));
}

glm::vec4 textured(const Geometry& geometry, const TextureSlot& slot, const Hit& hit) {
    if (slot.texture < 0 || geometry.uvs.empty()) return glm::vec4(1.0f);
    return texel(geometry.textures[static_cast<std::size_t>(slot.texture)],
                 glm::vec2(slot_uv(slot, glm::dvec4(between(geometry.uvs, geometry, hit)))));
}

// The normal that a normal texture gives in place of `normal`, of the front, unit.
//                                                                    [glTF 2.0, section 3.9.3]
glm::dvec3 mapped(const Geometry& geometry, const Material& material, const Hit& hit,
                  const Hit& texture_at, const glm::dvec3& normal) {
    const SceneTriangle& triangle = geometry.triangles[hit.triangle];
    const TextureSlot& slot = material.normal_texture;
    glm::dvec3 corner[3];
    glm::dvec2 uv[3];
    for (int k = 0; k < 3; ++k) {
        corner[k] = glm::dvec3(geometry.positions[triangle.vertex[k]]);
        uv[k] = slot_uv(slot, glm::dvec4(geometry.uvs[triangle.vertex[k]]));
    }
    // The plane's point moves by these for a step in u and in v.
    const glm::dmat2 steps(uv[1] - uv[0], uv[2] - uv[0]);
    if (glm::determinant(steps) == 0.0) return normal;
    const glm::dmat2 inverse = glm::inverse(steps);
    const glm::dvec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
    const glm::dvec3 along_u = e1 * inverse[0][0] + e2 * inverse[0][1];
    const glm::dvec3 along_v = e1 * inverse[1][0] + e2 * inverse[1][1];
    const glm::dvec3 flat = along_u - normal * glm::dot(along_u, normal);
    if (!(glm::length(flat) > 0.0)) return normal;
    const glm::dvec3 tangent = glm::normalize(flat);
    // Up in the picture, where v falls.
    const bool mirrored = glm::dot(glm::cross(along_u, along_v), glm::cross(e1, e2)) > 0.0;
    const glm::dvec3 bitangent = glm::cross(normal, tangent) * (mirrored ? -1.0 : 1.0);
    const glm::dvec3 read = 2.0 * glm::dvec3(textured(geometry, slot, texture_at)) - 1.0;
    const double scale = double{material.normal_scale};
    const glm::dvec3 out = scale * read.x * tangent + scale * read.y * bitangent + read.z * normal;
    return glm::length(out) > 0.0 ? glm::normalize(out) : normal;
}

// Bends a normal that faces away from the viewer, or nearly, until its cosine is 0.01 before it is
// unit again.
glm::dvec3 bent(const glm::dvec3& normal, const glm::dvec3& direction) {
    const double away = glm::dot(normal, direction) + 0.01;
    return away > 0.0 ? glm::normalize(normal - away * direction) : normal;
}

// Textures go on beside the triangle, vertex colours end with it.
glm::vec4 base(const Geometry& geometry, const Hit& hit, const Hit& texture_at) {
    const Material& material = geometry.materials[geometry.triangles[hit.triangle].material];
    glm::vec4 color = material.base_color * textured(geometry, material.base_texture, texture_at);
    if (!geometry.colors.empty()) color *= between(geometry.colors, geometry, hit);
    return color;
}

}  // namespace

bool opaque(const Geometry& geometry, const Hit& hit, std::uint64_t chance) {
    const Material& material = geometry.materials[geometry.triangles[hit.triangle].material];
    if (material.alpha_mode == AlphaMode::opaque) return true;
    const float alpha = base(geometry, hit, hit).w;
    if (material.alpha_mode == AlphaMode::mask) return alpha >= material.alpha_cutoff;
    // Embree may ask twice about a hit: the answer is the same.
    return Random(chance, hit.triangle, 0)() < alpha;
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

// By the corners of the triangle, not by the size of the scene: in a room in the middle of a large
// terrain positions are as exact as in the room alone.
float lift_of(const Geometry& geometry, std::uint32_t index) {
    float largest = 0.0f;
    for (const std::uint32_t vertex : geometry.triangles[index].vertex) {
        const glm::vec3 size = glm::abs(geometry.positions[vertex]);
        largest = std::max({largest, size.x, size.y, size.z});
    }
    return rounding * largest;
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
    out.lift = lift_of(geometry, hit.triangle);
    out.normal = side * between(geometry.normals, geometry, hit);
    const float length = glm::length(out.normal);
    // A shading normal that vanishes or faces away from the viewer gives way to the geometric one.
    out.normal = length > 0.0f && glm::dot(out.normal, direction) < 0.0f ? out.normal / length
                                                                         : out.geometric;
    out.reflects = front || material.double_sided;
    if (!out.reflects) return out;
    if (material.normal_texture.texture >= 0 && !geometry.uvs.empty())
        out.normal = glm::vec3(bent(double{side} * mapped(geometry, material, hit, texture_at,
                                                          double{side} * glm::dvec3(out.normal)),
                                    glm::dvec3(direction)));
    glm::vec2 finish(material.metallic, material.roughness);
    if (material.metallic_roughness_texture.texture >= 0 && !geometry.uvs.empty()) {
        const glm::vec4 read = textured(geometry, material.metallic_roughness_texture, texture_at);
        finish = material.metallic_roughness_factor * glm::vec2(read.z, read.y);
    }
    const float alpha = std::max(finish.y * finish.y, MICROFACET_LEAST_ALPHA);
    const float root = (1.0f - material.ior) / (1.0f + material.ior);
    out.metallic = double{finish.x};
    out.alpha = double{alpha};
    out.f90 = double{material.specular};
    out.f0 = out.f90 * double{root * root};
    out.base = glm::vec3(base(geometry, hit, texture_at));
    out.albedo = out.base *
                 microfacet_means(finish.x, alpha, static_cast<float>(out.f0), material.specular).x;
    out.emission = material.emission;
    if (luminance(out.emission) > 0.0f)
        out.emission *= glm::vec3(textured(geometry, material.emission_texture, texture_at));
    return out;
}

}  // namespace clgi::reference
