// SPDX-License-Identifier: MIT
#include "shading/lights/lamp_powers.hpp"

#include <algorithm>

namespace clgi {

LampPowers::LampPowers(const std::vector<EmissiveTriangle>& triangles,
                       const std::vector<double>& powers) {
    double total = 0.0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const bool begins = i > 0 && triangles[i].lamp != triangles[i - 1].lamp;
        if (begins && total > (lamp_ends_.empty() ? 0.0 : lamp_ends_.back()))
            lamp_ends_.push_back(total);
        ends_.push_back(total += powers[i]);
    }
}

std::vector<PowerStretch> LampPowers::stretches(int count, bool by_lamp) const {
    const double share = total() / count, least = 1e-9 * share;
    std::vector<double> cuts;
    if (by_lamp && lamp_ends_.size() <= static_cast<std::size_t>(count)) cuts = lamp_ends_;
    for (int k = 1; k < count; ++k) cuts.push_back(k * share);
    cuts.push_back(total());
    std::sort(cuts.begin(), cuts.end());
    std::vector<PowerStretch> out;
    double begin = 0.0;
    for (const double cut : cuts) {
        if (!(cut - begin > least)) continue;
        out.push_back({begin, cut});
        begin = cut;
    }
    return out;
}

std::size_t LampPowers::at(double place) const {
    const auto found = std::upper_bound(ends_.begin(), ends_.end(), place);
    return std::min<std::size_t>(found - ends_.begin(), ends_.size() - 1);
}

}  // namespace clgi
