// Regions of triangles, laid flat.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/adjacency.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

struct FlatChart {
    std::uint32_t region;                  // that it was made of
    std::vector<std::uint32_t> triangles;  // of the scene
    std::vector<glm::dvec2> corners;       // [3 * triangles] metres, within (0, 0) and `extent`
    glm::dvec2 extent;                     // metres; x is at least y
};

// A triangle that would keep less than this share of its area is not laid onto the plane.
constexpr double least_share = 0.5;

// In the order in which the regions appear. Each chart lies in the smallest rectangle around it.
// mesh: adjacency(scene), or null: it is found where it is needed.
std::vector<FlatChart> flatten(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                               const Adjacency* mesh);

// Turns corners into the smallest rectangle around them, its lower corner at 0 and its longer side
// along x. Returns its extent.
glm::dvec2 turn_upright(std::vector<glm::dvec2>& corners);

}  // namespace clgi
