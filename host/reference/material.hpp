// What a ray finds where it meets a surface, by docs/materials.md.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "reference/geometry.hpp"

namespace clgi::reference {

// Four numbers of a metallic-roughness material.
struct Gloss {
    float diffuse, coat, lobe, exponent;
};
Gloss gloss(float metallic, float roughness);

struct Surface {
    glm::vec3 position;
    glm::vec3 geometric;  // unit, towards the viewer
    glm::vec3 normal;     // shading, unit, towards the viewer
    glm::vec3 albedo;     // diffuse reflectance
    glm::vec3 lobe;       // weight of the Phong lobe
    float exponent;
    glm::vec3 emission;  // cd/m^2 on the side that is seen
    bool reflects;       // the side that is seen is one that sends light
};

// direction: of the ray that met it, unit. texture_at: where textures are
// read, a point of the triangle's plane.
Surface surface_at(const Geometry& geometry, const Hit& hit, const glm::vec3& direction,
                   const Hit& texture_at);
inline Surface surface_at(const Geometry& geometry, const Hit& hit, const glm::vec3& direction) {
    return surface_at(geometry, hit, direction, hit);
}

// Whether an alpha mask leaves this point of the triangle standing.
bool opaque(const Geometry& geometry, const Hit& hit);

glm::vec3 geometric_normal(const Geometry& geometry, std::uint32_t triangle);

// Linear rgb and alpha, bilinear on the full picture.
glm::vec4 texel(const Texture& texture, glm::vec2 uv);

}  // namespace clgi::reference
