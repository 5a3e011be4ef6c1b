// Generated rooms for tests and benchmarks: a box with a mesh, a corridor with doors.
//
// Every scene has a camera and a light. All surfaces are diffuse (metallic 0, roughness 1). Lengths
// in metres, angles in radians. An option out of range throws Error.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/procedural.hpp>
#include <clgi/scene.hpp>
#include <glm/glm.hpp>

namespace clgi {

// A closed room of 12 triangles with a mesh floating in its middle, one light near the front of
// the ceiling and the camera at the front wall: the test scene of [Cochran07].
struct BoxOptions {
    LightSource light = LightSource::spot;            // spot or point
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
Scene box(const Scene& mesh, const BoxOptions& options = {});
Scene box(const BoxOptions& options = {});  // with bumpy_mesh()

// A star-shaped solid, about 2 m across, of 69,451 triangles: as many as the Stanford bunny has.
Scene bumpy_mesh();

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
Scene corridor(const CorridorOptions& options = {});

}  // namespace clgi
