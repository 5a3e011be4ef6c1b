// Lambert and the normalised modified Phong lobe: value, direction at random, density.
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

    // Reflected radiance for unit irradiance from a direction, cosine left out, per steradian.
    glm::vec3 diffuse() const { return surface_.albedo / pi; }
    glm::vec3 lobe(const glm::vec3& light) const;

    // Density of sample() at a direction, per steradian. glossy: the lobe is drawn from as well.
    float density(const glm::vec3& light, bool glossy) const;
    glm::vec3 sample(Random& random, bool glossy) const;

private:
    float lobe_share(bool glossy) const;

    const Surface& surface_;
    glm::vec3 mirror_;
};

}  // namespace clgi::reference
