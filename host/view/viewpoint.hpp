// Where a camera stands and what it looks at, and how mouse and keys move it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>

namespace clgi::view {

// Metres; the vertical is +Y.
struct Viewpoint {
    glm::dvec3 eye = glm::dvec3(0.0);
    glm::dvec3 target = glm::dvec3(0.0, 0.0, -1.0);
};

// Of a camera: it looks at the point of its axis that is nearest to the middle of the box.
Viewpoint viewpoint_of(const Camera& camera, const Bounds& box);

// Around the target, radians to the right and up; one degree from the vertical at most.
void orbit(Viewpoint& viewpoint, double right, double up);

// The same of what is looked at, around the eye.
void look(Viewpoint& viewpoint, double right, double up);

// Both move, metres to the right, up and forward.
void walk(Viewpoint& viewpoint, const glm::dvec3& by);

// So many times as far from the target, within a ten thousandth and ten thousand radii of the
// scene.
void approach(Viewpoint& viewpoint, double factor, double radius);

}  // namespace clgi::view
