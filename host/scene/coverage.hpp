// How much of what lies behind a surface hides, by its alpha.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "scene/texture_mean.hpp"

namespace clgi {

// The share that a material covers where it has this alpha, in [0,1].
double covered(const Material& material, double alpha);

class Coverage {
public:
    // scene: must outlive it.
    explicit Coverage(const Scene& scene);

    // At a point of a triangle, by the weights of its corners. Textures at their finest level.
    double operator()(const SceneTriangle& triangle, const glm::dvec3& weight) const;

    // Texels of alpha along the longest side of the triangle; 0: no texture decides.
    double texels(const SceneTriangle& triangle) const;

private:
    bool reads(const Material& material) const;

    const Scene& scene_;
    std::vector<TextureMean> textures_;  // empty ones where no alpha is read
};

}  // namespace clgi
