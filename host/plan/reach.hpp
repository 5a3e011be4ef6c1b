// What a picture reaches: the places that it shows and those that send light there, followed from
// the camera backwards.                    [derived: Smits92, importance; Veach97, 4.6, its paths]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/reach.hpp>
#include <clgi/scene.hpp>
#include <optional>

#include "plan/local_scene.hpp"

namespace clgi {

// Paths of three surfaces through some hundred pixels, or fewer where there are many triangles.
// The camera has passed validate().
Reach reach_of(const Scene& scene, const LocalScene& local, const Camera& camera, int width,
               int height);

// None where the picture reaches most of the scene.
std::optional<Focus> focus_of(const Reach& reach);

// Shadow maps of a directional light, and the radius in metres that the finest of them covers.
struct SunMaps {
    int count = 1;
    double radius = 0.0;
};
SunMaps sun_maps(const Reach& reach);

}  // namespace clgi
