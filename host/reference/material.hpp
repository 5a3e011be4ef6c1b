// What a ray finds where it meets a surface, by docs/materials.md.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "reference/geometry.hpp"
#include "reference/random.hpp"

namespace clgi::reference {

struct Surface {
    glm::vec3 position;
    glm::vec3 geometric;  // unit, towards the viewer
    float lift;           // how far off it rays begin and end: more than positions are rounded by
    glm::vec3 normal;     // shading, unit, towards the viewer
    glm::vec3 albedo;     // diffuse reflectance in even light
    glm::vec3 base;       // colour
    double metallic;      // [0,1]
    double alpha;         // of GGX
    double f0, f90;       // F of what is no metal, at normal and at grazing incidence
    glm::vec3 emission;   // cd/m^2 on the side that is seen
    bool reflects;        // the side that is seen is one that sends light
};

// The point moved off its surface, to the side that is seen.
inline glm::vec3 off_surface(const Surface& surface) {
    return surface.position + surface.lift * surface.geometric;
}

// direction: of the ray that met it, unit. texture_at: where textures are
// read, a point of the triangle's plane.
Surface surface_at(const Geometry& geometry, const Hit& hit, const glm::vec3& direction,
                   const Hit& texture_at);
inline Surface surface_at(const Geometry& geometry, const Hit& hit, const glm::vec3& direction) {
    return surface_at(geometry, hit, direction, hit);
}

// Whether this point of the triangle is there: an alpha mask leaves it, or it is blended and chance
// decides so, which it does for a share alpha of all bits.
bool opaque(const Geometry& geometry, const Hit& hit, std::uint64_t chance);

// Bits that decide so for one ray; scenes that blend nothing draw none.
inline std::uint64_t chance(const Geometry& geometry, Random& random) {
    return geometry.blended ? random.bits() : 0;
}

glm::vec3 geometric_normal(const Geometry& geometry, std::uint32_t triangle);

// Linear rgb and alpha, bilinear on the full picture.
glm::vec4 texel(const Texture& texture, glm::vec2 uv);

}  // namespace clgi::reference
