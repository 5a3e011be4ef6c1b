// How far two answers of an AntiradianceSolver differ.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/antiradiance.hpp>
#include <glm/glm.hpp>
#include <vector>

namespace clgi::lab {

// Root mean square of the difference of luminance over the mean luminance of the second, both
// weighted by area. Not a number where a value is none; 0 where the second is black.
double leaf_difference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b,
                       const std::vector<double>& areas);

// Of each leaf: what arrives over links and from the sky, exposed lux, in rgb; and m^2.
std::vector<glm::vec4> leaf_irradiances(const cl::CommandQueue& queue,
                                        const AntiradianceSolver& solver);
std::vector<double> leaf_areas(const AntiradianceSolver& solver);

}  // namespace clgi::lab
