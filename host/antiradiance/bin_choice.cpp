// SPDX-License-Identifier: MIT
#include "antiradiance/bin_choice.hpp"

#include <cmath>

namespace clgi {

BinChoice::BinChoice(const DirectionBins& bins)
    : bins_(bins),
      farthest_(std::cos(2.0 * std::sqrt(4.0 * 3.14159265358979323846 / bins.count()))) {}

std::optional<int> BinChoice::operator()(const glm::dvec3& direction, const BinDemand& sender,
                                         const BinDemand& receiver) const {
    const auto meets = [&](const glm::dvec3& w) { return sender.met(w) && receiver.met(w); };
    const int nearest = bins_.nearest(direction);
    if (meets(bins_.directions[static_cast<std::size_t>(nearest)])) return nearest;
    std::optional<int> best;
    double most = farthest_;
    for (int j = 0; j < bins_.count(); ++j) {
        const glm::dvec3& w = bins_.directions[static_cast<std::size_t>(j)];
        const double along = glm::dot(w, direction);
        if (along <= most || !meets(w)) continue;
        most = along;
        best = j;
    }
    return best;
}

}  // namespace clgi
