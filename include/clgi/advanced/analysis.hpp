// What a scene has and what it does not have, found on the host before anything runs on a device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstddef>

namespace clgi {

// Whether anything can lie between two points. True is proven: nothing does, to within the rounding
// of positions on the device, 2^-22 of the scene's radius rounded up to a power of two. False says
// that something may.
//
// Proofs go by planes: surfaces that all lie on the boundary of a convex body have every triangle's
// plane as a supporting plane, with all vertices on one side of it. Nothing is proven of surfaces
// that move or will (Scene::moving_bounds is set), or that lie in the same place. Triangles with an
// alpha mask count as whole. The work is bounded: a scene of more than 1e8 tests of a plane and a
// vertex, as a sphere of more than some 10,000 triangles has, counts as not proven.
struct OpennessProof {
    bool surfaces_open = false;   // nothing lies between two points of surfaces
    bool surfaces_apart = false;  // and no surface has another before it, so no light goes on
    // Nothing lies between a point, spot or directional light with power, or a point of an emissive
    // surface, and a point of a surface that it lights. Lights stand still, strictly inside a
    // convex room or before the whole scene; cones and ranges are not considered.
    bool lights_open = false;
    // Nor between a surface and any part of the sky: surfaces_apart, and the normals that light is
    // shaded by are those of triangles, to within a degree. Others look below the surface.
    bool environment_open = false;
};

struct LightAnalysis {
    std::size_t points = 0, spots = 0, directional = 0;  // with power: intensity above 0
    std::size_t dark_points = 0, dark_spots = 0, dark_directional = 0;  // without
    bool moving = false;  // a clip moves a node that carries one of them
    // With area and radiance: of texels that no mask cuts out.
    std::size_t emissive_triangles = 0;
    bool emission =
        false;  // some surface may be seen to emit; its power may be too little to count
    bool environment = false;  // with radiance

    // Whether any light is not the environment.
    bool any_direct() const { return points + spots + directional + emissive_triangles > 0; }
};

// Of all that triangles reflect, weighted by area. Textures count by nine points of each triangle,
// in scenes of more than 30,000 triangles by some of their texels, with those that a mask cuts out.
struct SurfaceAnalysis {
    std::size_t triangles = 0;
    double area = 0.0;               // m^2, both sides of double-sided ones are one
    double largest_albedo = 0.0;     // no point of a triangle reflects more in any channel
    double gloss = 0.0;              // share of what is reflected, luminance, by lobes and coats
    double glossy_area = 0.0;        // share of area whose lobe and coat reflect more than 1e-4
    double double_sided_area = 0.0;  // share
    bool textures = false;  // a texture of a material in use, base or emission, is not one colour
    bool cutouts = false;   // a material in use may have alpha below its cutoff, or 1
    std::size_t vertices = 0;    // fewer than triangles where these share them
    std::size_t degenerate = 0;  // triangles without area, to within the rounding of positions
};

struct MotionAnalysis {
    bool geometry = false;         // some triangles have a vertex that follows what a clip moves
    double moving_area = 0.0;      // their share of the area, as the scene's arrays have it
    bool moving_emission = false;  // one of their materials emits
};

struct SceneAnalysis {
    LightAnalysis lights;
    SurfaceAnalysis surfaces;
    MotionAnalysis motion;
    OpennessProof proof;
    // Share of cosine-weighted directions in which nothing is seen, estimated by 64 to 1024 rays
    // from points spread evenly over the sides of surfaces that reflect, by area; 128 where the
    // share is far from those that plans ask for: 0.3, and 0.5 with an environment. 1 where
    // surfaces_apart, otherwise 0 where nothing reflects. Masked and blended ones count as whole;
    // geometry that moves is where the scene's arrays have it.
    double openness = 0.0;
    double milliseconds = 0.0;  // that the analysis took
};

// Throws InputError for a broken scene, as validate() does.
CLGI_API SceneAnalysis scene_analysis(const Scene& scene);

}  // namespace clgi
