// The sides of a scene's triangles that light meets: fronts, and backs of open sheets.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/scene.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clgi {

struct Face {
    std::array<glm::dvec3, 3> corners;  // metres, counter-clockwise seen from where it faces
    glm::dvec3 normal;                  // unit
    double area;                        // m^2
    std::uint32_t triangle;             // of the scene
    bool back;
};

struct Faces {
    std::vector<Face> faces;  // by triangle, the front first
    std::size_t skipped = 0;  // triangles
    double skipped_area = 0.0;
    Adjacency mesh;  // of the scene's triangles
};

// backs: of double-sided triangles and of those in pieces that are not closed.
Faces make_faces(const Scene& scene, bool backs);

// Floats could not tell the normal of a triangle in a scene about `middle`.
bool is_thin(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& middle);

inline glm::dvec3 centroid(const std::array<glm::dvec3, 3>& corners) {
    return corners[0] + ((corners[1] - corners[0]) + (corners[2] - corners[0])) / 3.0;
}

}  // namespace clgi
