// Directions and solid angles of an environment's picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>

namespace clgi {

// With a picture of one white texel where there was none. Nothing else changes.
Environment with_picture(Environment environment);

// Steradians of a texel in a row of a picture of this size.
double texel_solid_angle(int width, int height, int row);

// Unit direction in the world of a place in the picture, u to the right and v down, [0,1].
glm::dvec3 environment_direction(const Environment& environment, double u, double v);

// Radiance integrated over all directions: lux, of a plane that were turned to each of them.
glm::dvec3 environment_fluence(const Environment& environment);

}  // namespace clgi
