// Two generated scenes of known geometry, for first pictures and closed forms.
//
// Each has a camera and a light. All surfaces are diffuse (metallic 0,
// roughness 1). Lengths in metres, angles in radians. An option out of range throws Error.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <glm/glm.hpp>

namespace clgi {

// The light of a scene. area: an emissive surface.
enum class LightSource { spot, area, point };

// The Cornell box by its published measurements; the camera stands in front of the open side.
struct CornellOptions {
    LightSource light = LightSource::area;
    glm::vec3 radiance = glm::vec3(17.0f, 12.0f, 4.0f);   // cd/m^2; area
    glm::vec3 intensity = glm::vec3(1.5f, 1.35f, 1.15f);  // cd; spot and point
    float cone_angle = 0.6f;                              // from the axis; spot
};
CLGI_API Scene cornell(const CornellOptions& options = {});

// A sphere seen from inside, one reflectance everywhere, its light at the centre. The closed
// form: with a spot or point of flux Phi, indirect irradiance is rho Phi / (4 pi R^2 (1 - rho))
// everywhere; with an area light (the whole wall emits) radiosity is pi L / (1 - rho).
struct FurnaceOptions {
    LightSource light = LightSource::spot;
    float albedo = 0.5f;             // 0 to 0.999
    int subdivisions = 4;            // 0 to 8; 20 * 4^subdivisions triangles
    double radius = 1.0;             // of the sphere through all vertices
    float cone_angle = 0.52359878f;  // from the axis (30 degrees), hard edge; spot, aimed at -Y
    float intensity = 1.0f;          // cd; spot and point
    float radiance = 1.0f;           // cd/m^2; area
};
CLGI_API Scene furnace(const FurnaceOptions& options = {});

}  // namespace clgi
