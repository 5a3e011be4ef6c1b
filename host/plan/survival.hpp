// How much light goes on.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/plan/facts.hpp>

namespace clgi {

// Of the light that leaves surfaces, the share that they reflect again, on average: the mean albedo
// of the brightest channel times the share of directions in which there is a surface, with twice
// its standard error for safety.
inline double survival(const SceneFacts& facts) {
    const glm::dvec3& albedo = facts.surfaces.mean_albedo;
    const double stays = std::clamp(1.0 - facts.openness + 2.0 * facts.openness_error, 0.0, 1.0);
    return std::min(std::max({albedo.r, albedo.g, albedo.b}) * stays, 0.99);
}

}  // namespace clgi
