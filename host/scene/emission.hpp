// What a triangle of an emissive material shines with as a light source: the mean of its emission
// over its own texels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "scene/coverage.hpp"
#include "scene/texture_mean.hpp"

namespace clgi {

class EmissionMeans {
public:
    explicit EmissionMeans(const Scene& scene);

    // Radiance, cd/m^2: as much as alpha covers.
    glm::dvec3 operator()(const SceneTriangle& triangle) const;

private:
    glm::dvec3 masked(const SceneTriangle& triangle) const;

    const Scene& scene_;
    Coverage coverage_;
    std::vector<TextureMean> textures_;  // empty ones where no emission reads them
};

}  // namespace clgi
