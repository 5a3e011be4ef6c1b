// The parts of a SceneAnalysis. Every scene here has passed validate().
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/analysis.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

#include "scene/local_triangles.hpp"

namespace clgi {

struct SurfacesFound {
    SurfaceAnalysis analysis;
    std::vector<double> reflects;  // [triangles] albedo, of the channel that has most
};
SurfacesFound surface_analysis(const Scene& scene, const std::vector<LocalTriangle>& triangles);

double triangle_area(const Scene& scene, const SceneTriangle& triangle);  // m^2, one side

struct LightsFound {
    LightAnalysis analysis;
    std::vector<std::uint32_t> emissive;  // triangles with area
    std::vector<double> radiance;         // of each of them, luminance, cd/m^2
};
LightsFound light_analysis(const Scene& scene);

MotionAnalysis motion_analysis(const Scene& scene);

}  // namespace clgi
