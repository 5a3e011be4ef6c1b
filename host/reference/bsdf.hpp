// Reflectance of glTF 2.0, in double precision: value, direction at random, density.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "reference/material.hpp"
#include "reference/random.hpp"

namespace clgi::reference {

class Bsdf {
public:
    // toward: unit, from the surface to the viewer.
    Bsdf(const Surface& surface, const glm::vec3& toward);

    // Reflected radiance for unit irradiance from a direction, cosine left out, per steradian:
    // diffuse with the share of even light, or diffuse and gloss for this direction.
    glm::vec3 diffuse() const { return surface_.albedo / pi; }
    glm::vec3 reflected(const glm::vec3& light) const;

    // Density of sample() at a direction, per steradian. glossy: microfacets are drawn as well.
    float density(const glm::vec3& light, bool glossy) const;
    glm::vec3 sample(Random& random, bool glossy) const;

private:
    double lobe_share(bool glossy) const;
    glm::dvec3 microfacet(double u, double turn) const;

    const Surface& surface_;
    glm::dvec3 normal_, toward_;
    double cosine_;  // between them, above 0
    bool has_lobe_;  // else it is Lambertian
};

}  // namespace clgi::reference
