// SPDX-License-Identifier: MIT
#include "shading/lights/lamp_powers.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "scene/disjoint_sets.hpp"

namespace clgi {
namespace {

std::vector<std::uint32_t> lamps_of(const std::vector<EmissiveTriangle>& triangles) {
    const auto before = [](const glm::vec3& a, const glm::vec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    std::map<glm::vec3, std::uint32_t, decltype(before)> first(before);
    DisjointSets sets(triangles.size());
    for (std::uint32_t i = 0; i < triangles.size(); ++i)
        for (const glm::vec3& corner : triangles[i].corner)
            sets.join(first.try_emplace(corner, i).first->second, i);
    return sets.numbered();
}

}  // namespace

LampPowers::LampPowers(const std::vector<EmissiveTriangle>& triangles,
                       const std::vector<double>& powers)
    : order_(triangles.size()) {
    const std::vector<std::uint32_t> lamps = lamps_of(triangles);
    std::iota(order_.begin(), order_.end(), 0u);
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return lamps[a] < lamps[b]; });
    double total = 0.0;
    for (std::size_t i = 0; i < order_.size(); ++i) {
        if (i > 0 && lamps[order_[i]] != lamps[order_[i - 1]] && total > 0.0 &&
            (lamp_ends_.empty() || total > lamp_ends_.back()))
            lamp_ends_.push_back(total);
        ends_.push_back(total += powers[order_[i]]);
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
    return order_[std::min<std::size_t>(found - ends_.begin(), order_.size() - 1)];
}

}  // namespace clgi
