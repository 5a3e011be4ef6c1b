// A body around a skeleton: the smooth union of round cones as a distance, a closed mesh of its
// surface, and how much of each vertex follows each joint.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "lab/scenes/rigging.hpp"

namespace clgi::generated {

// A distance to a surface, below 0 inside, and how it grows with the place.
struct Slope {
    double distance;
    glm::dvec3 gradient;
};

// A cone with round ends that follows a joint.
struct Bone {
    std::uint32_t joint;
    glm::dvec3 from, to;
    double from_radius, to_radius;

    Slope slope(const glm::dvec3& p) const;
};

struct Flesh {
    std::vector<Bone> bones;
    double blend;  // metres within which bones flow together

    // Adds a bone and its mirror image at x = 0, which follows another joint.
    void add_pair(std::uint32_t left, std::uint32_t right, const glm::dvec3& from,
                  const glm::dvec3& to, double from_radius, double to_radius);

    // d = -k log(sum of exp(-d_i / k)) over all bones. [derived: smooth minimum]
    Slope slope(const glm::dvec3& p) const;
    // Where a ray from inside first leaves the surface by `gap`.
    glm::dvec3 leave(const glm::dvec3& from, const glm::dvec3& direction, double gap) const;
};

using TriangleCorners = std::array<std::uint32_t, 3>;

struct FleshMesh {
    std::vector<glm::dvec3> positions;
    std::vector<TriangleCorners> triangles;  // counter-clockwise seen from outside
};

// A closed mesh of so many vertices, triangles nearly equilateral. The surface must be a
// sphere's in shape: the mesh then has 2 vertices - 4 triangles. Throws Error if it is not.
FleshMesh mesh_of(const Flesh& flesh, std::size_t vertices);

// [vertices][joints], those of a vertex sum to 1: the joint of the nearest bone, blended with its
// parent and children, and smoothed along the surface. parents: of the joints.
std::vector<std::vector<double>> weights_of(const Flesh& flesh, const FleshMesh& mesh,
                                            const std::vector<int>& parents, int smoothings);

// Of points beside the mesh: those of the nearest of its vertices.
std::vector<std::vector<double>> weights_near(const std::vector<glm::dvec3>& points,
                                              const FleshMesh& mesh,
                                              const std::vector<std::vector<double>>& weights);

}  // namespace clgi::generated
