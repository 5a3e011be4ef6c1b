// The parts of a SceneAnalysis. Every scene here has passed validate().
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/analysis.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

#include "plan/local_triangles.hpp"

namespace clgi {

// What each triangle reflects of what meets it, per channel.
struct TriangleAlbedo {
    glm::dvec3 all = glm::dvec3(0.0);    // diffuse and gloss
    glm::dvec3 gloss = glm::dvec3(0.0);  // of lobe and coat alone
    glm::dvec3 least = glm::dvec3(0.0);  // no point of it reflects less
    glm::dvec3 most = glm::dvec3(0.0);   // nor more
};
std::vector<TriangleAlbedo> triangle_albedos(const Scene& scene);

// [triangles of the scene] triangles and albedos.
SurfaceAnalysis surface_analysis(const Scene& scene, const std::vector<LocalTriangle>& triangles,
                                 const std::vector<TriangleAlbedo>& albedos);

double triangle_area(const Scene& scene, const SceneTriangle& triangle);  // m^2, one side

struct LightsFound {
    LightAnalysis analysis;
    std::vector<std::uint32_t> emissive;  // triangles
};
LightsFound light_analysis(const Scene& scene);

MotionAnalysis motion_analysis(const Scene& scene);

}  // namespace clgi
