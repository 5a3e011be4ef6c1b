// What a scene has and what it does not have, found on the host before anything runs on a device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstddef>
#include <glm/glm.hpp>

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
    bool moving = false;                 // a clip moves a node that carries one of them
    std::size_t emissive_triangles = 0;  // with radiance: of texels that no mask cuts out
    double emissive_area = 0.0;          // m^2
    double emissive_power = 0.0;         // lumen, luminance: pi L A summed, both sides if they are
    bool emission =
        false;  // some surface may be seen to emit; its power may be too little to count
    bool environment = false;       // with radiance
    double environment_mean = 0.0;  // mean luminance over the sphere, cd/m^2

    // Whether any light is not the environment.
    bool any_direct() const { return points + spots + directional > 0 || emissive_power > 0.0; }
};

// Of all that triangles reflect, weighted by area. Textures count by nine points of each triangle,
// by one in scenes of more than 30,000 triangles, with texels that a mask cuts out.
struct SurfaceAnalysis {
    std::size_t triangles = 0;
    double area = 0.0;             // m^2, both sides of double-sided ones are one
    glm::dvec3 mean_albedo{0.0};   // of diffuse and gloss together, per channel
    double smallest_albedo = 0.0;  // no point of a triangle reflects less in any channel
    double largest_albedo = 0.0;   // nor more
    double gloss = 0.0;        // share of `mean_albedo`, luminance, that lobes and coats reflect
    double glossy_area = 0.0;  // share of area whose lobe and coat reflect more than 1e-4
    double double_sided_area = 0.0;  // share
    bool textures = false;  // a texture of a material in use, base or emission, is not one colour
    bool cutouts = false;   // a mask material in use may have alpha below its cutoff
    // m, of the longest edges of triangles with area.
    double smallest_edge = 0.0, median_edge = 0.0, largest_edge = 0.0;
    std::size_t vertices = 0;    // fewer than triangles where these share them
    std::size_t degenerate = 0;  // triangles without area, to within the rounding of positions
};

struct MotionAnalysis {
    bool geometry = false;             // some clip moves vertices of triangles
    std::size_t moving_triangles = 0;  // with a vertex that follows what a clip moves
    double moving_area = 0.0;          // their share of the area, as the scene's arrays have it
    bool moving_emission = false;      // one of their materials emits
    double travel = 0.0;  // largest way of a vertex from its place in the scene's arrays,
                          // over the diagonal of their bounds, at 3 to 25 times a clip
};

struct SceneAnalysis {
    LightAnalysis lights;
    SurfaceAnalysis surfaces;
    MotionAnalysis motion;
    OpennessProof proof;
    double size = 0.0;  // m, diagonal of the bounds

    // Estimated by rays from points spread evenly over the sides of surfaces that reflect, by area.
    // Where nothing reflects there are none, and all of it is 0, but openness where surfaces_apart.
    // Masked triangles count as whole; geometry that moves is where the scene's arrays have it.

    // Share of cosine-weighted directions in which nothing is seen, by 64 to 1024 rays, with its
    // standard error. Exact where surfaces_apart: 1, error 0.
    double openness = 0.0, openness_error = 0.0;
    // Share of the same rays that end on the back of a single-sided surface, where light is lost.
    double backs = 0.0;
    // From 64 to 256 points, to a standard error of 1/16 to 1/32 at most: the share that a point,
    // spot or directional light with power or an emissive surface meets, and of these the share
    // that several do. Too low where there are more than 16 lights, in scenes of more than 5,000
    // triangles fewer, of which each point looks for a part; and where there are several emissive
    // surfaces, which are one light that is looked for at one of its points.
    double lit = 0.0, lit_twice = 0.0;
    // From as many points on single-sided surfaces: the share that lies on walls thinner than a
    // hundredth of `size`, straight through to where the wall ends; and the least thickness found,
    // m, 0 if no wall ends. Light and shadow of one side may come to the other there, where texels,
    // pixels of shadow maps or leaves are larger.
    double thin = 0.0, thinnest = 0.0;

    double milliseconds = 0.0;  // that the analysis took
};

// Throws InputError for a broken scene, as validate() does, and if a clip moves a vertex beyond
// 1e18 m.
CLGI_API SceneAnalysis scene_analysis(const Scene& scene);

}  // namespace clgi
