// Through which bin two elements exchange light.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/direction_bins.hpp>
#include <optional>

#include "methods/antiradiance/bin_grid.hpp"

namespace clgi {

// What an end of a link demands of its bin: a cosine with `normal` of at least `least`.
struct BinDemand {
    glm::dvec3 normal{0.0};  // unit; zero: nothing is demanded
    double least = 0.0;

    bool met(const glm::dvec3& direction) const {
        return normal == glm::dvec3(0.0) || glm::dot(normal, direction) >= least;
    }
};

class BinChoice {
public:
    explicit BinChoice(const DirectionBins& bins);  // that must outlive this object

    // The bin nearest to `direction` (unit) among those that meet both demands, at most twice the
    // mean spacing of bins, and a right angle, away.
    std::optional<int> operator()(const glm::dvec3& direction, const BinDemand& sender,
                                  const BinDemand& receiver) const;

private:
    const DirectionBins& bins_;
    const double farthest_;  // cosine
    const BinGrid grid_;
};

}  // namespace clgi
