// Generated scenes: known geometry for tests, benchmarks and first pictures.
//
// Every scene has at least one camera and one light. All surfaces are diffuse (metallic 0,
// roughness 1). Lengths in metres, angles in radians. An option out of range throws Error.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/export.hpp>
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

// A closed room of 12 triangles with a mesh floating in its middle, one light near the front of
// the ceiling and the camera at the front wall: the test scene of [Cochran07].
struct BoxOptions {
    LightSource light = LightSource::spot;                           // spot or point
    glm::dvec3 size = glm::dvec3(2.0, 2.0, 3.0);      // width, height, depth
    double mesh_height = 0.45;                        // share of the box's height, (0,0.9]
    glm::vec3 left = glm::vec3(0.72f, 0.09f, 0.07f);  // reflectances, each in [0,1]
    glm::vec3 right = glm::vec3(0.10f, 0.42f, 0.12f);
    glm::vec3 walls = glm::vec3(0.75f, 0.75f, 0.73f);  // back, front, floor, ceiling
    glm::vec3 mesh = glm::vec3(0.78f, 0.77f, 0.74f);
    glm::vec3 intensity = glm::vec3(9.0f, 8.7f, 8.1f);  // cd, for the default size
    float cone_angle = 0.6f;                            // from the axis; spot
};
// Uses only the shape of the mesh, not its materials, lights and cameras. Intensity is scaled with
// the square of the box's height, so a box of any size looks the same.
CLGI_API Scene box(const Scene& mesh, const BoxOptions& options = {});
CLGI_API Scene box(const BoxOptions& options = {});  // with bumpy_mesh()

// A star-shaped solid, about 2 m across, of 69,451 triangles: as many as the Stanford bunny has.
CLGI_API Scene bumpy_mesh();

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

// A corridor with rooms behind doors on both sides. A spot near one end shines along it, so only
// light through the doors reaches the rooms. No edge ends in the middle of another one.
struct CorridorOptions {
    int rooms = 3;                                         // on either side, 1 to 64
    float door_angle = 1.2f;                               // 0: closed, up to 2.97; from 2.6 on,
                                                           // doors on the right are mid-room
    double width = 2.0;                                    // of the corridor, at least 0.5
    double height = 2.5;                                   // at least 2.2 (doors are 2.05 high)
    double room_length = 4.0;                              // along the corridor, at least 3
    double room_depth = 3.0;                               // away from it, at least 1.5
    glm::vec3 intensity = glm::vec3(60.0f, 57.0f, 52.0f);  // cd
    float cone_angle = 0.5f;                               // from the axis
};
CLGI_API Scene corridor(const CorridorOptions& options = {});

}  // namespace clgi
