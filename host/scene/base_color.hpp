// The base colour of a triangle: the mean of its texture over its own texels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "scene/texture_mean.hpp"

namespace clgi {

class BaseColorMeans {
public:
    // scene: must outlive it. Without sums, estimate() alone may be called.
    explicit BaseColorMeans(const Scene& scene, bool sums = true);

    // Factor times texture, linear, without vertex colours. Texels that a mask cuts out count.
    glm::dvec3 operator()(const SceneTriangle& triangle) const;

    // The same from side^2 points of the triangle, whatever the number of texels that it covers.
    glm::dvec3 estimate(const SceneTriangle& triangle, int side) const;

private:
    const Scene& scene_;
    std::vector<TextureMean> textures_;  // empty ones where no base colour reads them
};

}  // namespace clgi
