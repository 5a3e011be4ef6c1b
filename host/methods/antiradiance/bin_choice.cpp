// SPDX-License-Identifier: MIT
#include "methods/antiradiance/bin_choice.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clgi {

BinChoice::BinChoice(const DirectionBins& bins)
    : bins_(bins),
      farthest_(std::cos(std::min(2.0 * std::sqrt(4.0 * std::numbers::pi / bins.count()),
                                  0.5 * std::numbers::pi))),
      grid_(bins, farthest_) {}

std::optional<int> BinChoice::operator()(const glm::dvec3& direction, const BinDemand& sender,
                                         const BinDemand& receiver) const {
    const auto meets = [&](const glm::dvec3& w) { return sender.met(w) && receiver.met(w); };
    const int here = grid_.nearest(direction);
    if (meets(bins_.directions[static_cast<std::size_t>(here)])) return here;
    std::optional<int> best;
    double most = farthest_;
    for (const std::uint16_t i : grid_.around(direction)) {
        const int j = glm::dot(bins_.directions[i], direction) < 0.0 ? bins_.opposite(i) : i;
        const glm::dvec3& w = bins_.directions[static_cast<std::size_t>(j)];
        const double along = glm::dot(w, direction);
        if (along <= most || !meets(w)) continue;
        most = along;
        best = j;
    }
    return best;
}

}  // namespace clgi
