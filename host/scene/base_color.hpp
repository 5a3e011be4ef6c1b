// The base colour of a triangle: the mean of its texture over its own texels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "scene/texture_mean.hpp"

namespace clgi {

class BaseColorMeans {
public:
    explicit BaseColorMeans(const Scene& scene);  // which must outlive it

    // Factor times texture, linear, without vertex colours. Texels that a mask cuts out count.
    glm::dvec3 operator()(const SceneTriangle& triangle) const;

    // The same from nine points of the triangle, whatever the number of texels that it covers.
    glm::dvec3 estimate(const SceneTriangle& triangle) const;

private:
    const Scene& scene_;
    std::vector<TextureMean> textures_;  // empty ones where no base colour reads them
};

}  // namespace clgi
