// What a scene has and what it does not: read on the host, before anything runs on a device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/export.hpp>
#include <clgi/scene.hpp>
#include <cstddef>
#include <glm/glm.hpp>

namespace clgi {

// Whether anything can lie between two points. Proven, not guessed: a convex set of surfaces has
// every triangle's plane as a supporting plane, all vertices on one side of it to within the
// rounding of positions in single precision. `open` is proof; without it something may occlude.
// Geometry that moves is never proven open.
struct OpennessProof {
    bool surfaces_open = false;    // nothing lies between two points of surfaces that face each other
    bool surfaces_apart = false;   // stronger: no surface faces another, so no light goes on
    bool lights_open = false;      // nothing lies between a point, spot, directional light or sample
                                   // of an emissive surface and a point that it lights
    bool environment_open = false; // nor between a surface and the environment
};

struct LightFacts {
    std::size_t points = 0, spots = 0, directional = 0;  // with power: intensity above 0
    bool moving = false;                   // nodes with lights are animated
    std::size_t emissive_triangles = 0;    // with radiance, textures and vertex colours included
    double emissive_area = 0.0;            // m^2
    double emissive_power = 0.0;           // lumen, luminance: pi L A summed, both sides if they are
    bool environment = false;              // with radiance
    double environment_mean = 0.0;         // mean luminance over the sphere, cd/m^2
};

// Of all that triangles reflect, weighted by area. Textures count by the mean over the triangle.
struct SurfaceFacts {
    std::size_t triangles = 0;
    double area = 0.0;                 // m^2, both sides of double-sided ones are one
    glm::dvec3 mean_albedo{0.0};       // of diffuse and gloss together, per channel
    double largest_albedo = 0.0;       // of any triangle and channel
    double gloss = 0.0;                // share of `mean_albedo`, luminance, that lobes and coats reflect
    double glossy_area = 0.0;          // share of area with any gloss
    double double_sided_area = 0.0;    // share
    bool textures = false;             // some material's texture, base or emission, is not one colour
    bool cutouts = false;              // some mask material has texels below its cutoff
    double smallest_edge = 0.0, median_edge = 0.0, largest_edge = 0.0;  // m, longest edge of triangles
    std::size_t degenerate = 0;        // triangles without area
};

struct MotionFacts {
    bool geometry = false;             // the animation moves vertices
    std::size_t moving_triangles = 0;
    double travel = 0.0;               // largest way of a vertex from its place in the scene's arrays,
                                       // of the diagonal of the scene's bounds, over the sampled times
};

struct SceneFacts {
    LightFacts lights;
    SurfaceFacts surfaces;
    MotionFacts motion;
    OpennessProof proof;
    double size = 0.0;       // m, diagonal of the bounds
    // Share of cosine-weighted directions from the sides of surfaces that reflect, weighted by area,
    // in which nothing is seen; estimated, its standard error beside it. 1 where surfaces_apart.
    double openness = 0.0, openness_error = 0.0;
    // Share of the same rays that end on the back of a single-sided surface, where light is lost.
    double backs = 0.0;
    double milliseconds = 0.0;  // that reading the facts took
};

// Throws InputError for a broken scene, as validate() does.
CLGI_API SceneFacts scene_facts(const Scene& scene);

}  // namespace clgi
