// SPDX-License-Identifier: MIT
#include "antiradiance/bin_choice.hpp"

#include <algorithm>
#include <cmath>

namespace clgi {

BinChoice::BinChoice(const DirectionBins& bins)
    : bins_(bins),
      farthest_(std::cos(2.0 * std::sqrt(4.0 * 3.14159265358979323846 / bins.count()))) {
    constexpr double rounding = 1e-12;
    for (const glm::dvec3& one : bins.directions) {
        double nearest = -1.0;
        for (const glm::dvec3& other : bins.directions)
            if (&other != &one) nearest = std::max(nearest, glm::dot(one, other));
        sure_.push_back(std::sqrt(0.5 * (1.0 + nearest)) + rounding);
    }
}

int BinChoice::nearest(const glm::dvec3& direction) {
    const auto last = static_cast<std::size_t>(last_);
    if (!(glm::dot(direction, bins_.directions[last]) > sure_[last]))
        last_ = bins_.nearest(direction);
    return last_;
}

std::optional<int> BinChoice::operator()(const glm::dvec3& direction, const BinDemand& sender,
                                         const BinDemand& receiver) {
    const auto meets = [&](const glm::dvec3& w) { return sender.met(w) && receiver.met(w); };
    const int here = nearest(direction);
    if (meets(bins_.directions[static_cast<std::size_t>(here)])) return here;
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
