// Texels of a lightmap: which triangle's chart covers each one's centre, and where on it.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <vector>

namespace clgi {

struct UvTexel {
    std::uint32_t texel = 0;     // row * size + column; row 0 at v = 0, column 0 at u = 0
    std::uint32_t triangle = 0;  // of the scene
    double b1 = 0.0;             // weights of its second and third corner
    double b2 = 0.0;
};

struct UvTexels {
    std::vector<UvTexel> texels;   // in rising order; of several triangles the first counts
    std::size_t overlapping = 0;   // texels whose centre several triangles cover
    std::size_t outside = 0;       // triangles half a texel or more outside the unit square; left
                                   // out
    std::size_t without_area = 0;  // triangles without area in this UV set
};

// Texture coordinates of a triangle's corners in one of the two sets. There must be some.
std::array<glm::dvec2, 3> uv_corners(const Scene& scene, std::uint32_t triangle, int uv_set);

// uv_set: 0 or 1. size: texels, side of the square; 1 to 16384. A centre on an edge that two
// triangles share belongs to one of them. Throws Error for numbers out of range.
CLGI_API UvTexels uv_texels(const Scene& scene, int uv_set, int size);

// The surface at a texel's centre.
struct UvPlace {
    glm::dvec3 position;   // metres
    glm::dvec3 normal;     // unit, interpolated; `geometric` where it would face away from it
    glm::dvec3 geometric;  // unit, of the triangle; `normal` where the triangle has no area
};
CLGI_API UvPlace place_at(const Scene& scene, const UvTexel& texel);

}  // namespace clgi
