// Generated rooms that are lit almost by indirect light alone, with about as many triangles as the
// scenes of [Dachsbacher07, figures 12 to 16, table 1]. Their shapes are our own.
//
// Every scene has a camera and a light. Whatever stands in a room is closed, and so are the walls:
// rooms with an opening have walls of a thickness, with an outer side. Lengths in metres. An option
// out of range throws Error.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>

namespace clgi {

// Passages around walls of full height. A directional light enters through an opening above and
// meets a wall on its side away from the camera: the camera sees no surface that it meets.
struct MazeOptions {
    float illuminance = 60.0f;  // lux of a surface that faces the light
};
Scene maze(const MazeOptions& options = {});

// A furnished room. A directional light comes through the window on the left and meets the wall on
// the right.
struct OfficeOptions {
    float illuminance = 45.0f;  // lux of a surface that faces the light
};
Scene office(const OfficeOptions& options = {});

// The same with a figure that walks in a circle and waves: one closed surface and a skin of 16
// joints, in a clip of 6.4 s that can be repeated.
Scene character(const OfficeOptions& options = {});

// A living room behind carved windows, with screens, lanterns, cushions and low tables.
struct OrientalOptions {
    float illuminance = 70.0f;  // lux of a surface that faces the light
};
Scene oriental_like(const OrientalOptions& options = {});

// A cube with round edges, of 3,072 triangles, that shines; in a room, under a spot.
struct GlossyOptions {
    float roughness = 0.45f;  // of the object, [0.05,1]; at 1 it is diffuse
    float metallic = 0.6f;    // of the object, [0,1]
    float intensity = 40.0f;  // cd
};
Scene glossy_box(const GlossyOptions& options = {});

// A bust of 12,940 triangles that shines, on a pedestal in a room. The spot lights the wall beside
// it, so that the bust receives indirect light alone.
Scene glossy_bust_like(const GlossyOptions& options = {});

}  // namespace clgi
