// Through which bin two elements exchange light.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/direction_bins.hpp>
#include <optional>
#include <vector>

namespace clgi {

// What an end of a link demands of its bin: a cosine with `normal` of at least `least`.
struct BinDemand {
    glm::dvec3 normal{0.0};  // unit; zero: nothing is demanded
    double least = 0.0;

    bool met(const glm::dvec3& direction) const {
        return normal == glm::dvec3(0.0) || glm::dot(normal, direction) >= least;
    }
};

// Not for several threads: it remembers the bin of the last direction, which is often that of the
// next one.
class BinChoice {
public:
    explicit BinChoice(const DirectionBins& bins);

    // The bin nearest to `direction` (unit) among those that meet both demands, at most twice the
    // mean spacing of bins away.
    std::optional<int> operator()(const glm::dvec3& direction, const BinDemand& sender,
                                  const BinDemand& receiver);

private:
    int nearest(const glm::dvec3& direction);

    const DirectionBins& bins_;
    double farthest_;           // cosine
    std::vector<double> sure_;  // [bins] cosine of half the angle to the nearest other bin
    int last_ = 0;
};

}  // namespace clgi
