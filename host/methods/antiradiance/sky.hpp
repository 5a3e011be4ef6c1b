// Light from outside the scene, in bins of directions.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/direction_bins.hpp>
#include <clgi/scene.hpp>
#include <optional>
#include <vector>

namespace clgi {

// [bins] the mean radiance, cd/m^2, that an environment sends along each bin; 0 without one.
// [Dachsbacher07, section 3.3]
std::vector<glm::dvec3> sky_row(const std::optional<Environment>& environment,
                                const DirectionBins& bins);

}  // namespace clgi
