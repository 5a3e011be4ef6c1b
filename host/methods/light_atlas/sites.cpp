// SPDX-License-Identifier: MIT
#include "methods/light_atlas/sites.hpp"

#include <algorithm>
#include <utility>

#include "methods/light_atlas/nearest.hpp"

namespace clgi {
namespace {

// The nearest point that its site can spare.
std::uint32_t spare_point(const std::vector<glm::dvec3>& points, const glm::dvec3& site,
                          const std::vector<std::uint32_t>& owner,
                          const std::vector<std::uint32_t>& members) {
    std::uint32_t best = 0;
    double best_squared = -1.0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        if (members[owner[i]] < 2) continue;
        const glm::dvec3 d = points[i] - site;
        const double squared = glm::dot(d, d);
        if (best_squared >= 0.0 && !(squared < best_squared)) continue;
        best = i;
        best_squared = squared;
    }
    return best;
}

using Divided = std::function<bool(std::uint32_t point, std::uint32_t site)>;

// The nearest site on the point's side, or else `nearest`, of which it is known that it is not.
std::uint32_t undivided_site(std::uint32_t point, const glm::dvec3& at,
                             const std::vector<glm::dvec3>& sites, std::uint32_t nearest,
                             const Divided& divided) {
    constexpr std::size_t most = 16;
    thread_local std::vector<std::pair<double, std::uint32_t>> near;
    near.clear();
    for (std::uint32_t s = 0; s < sites.size(); ++s) {
        const glm::dvec3 d = sites[s] - at;
        near.emplace_back(glm::dot(d, d), s);
    }
    const auto last = near.begin() + static_cast<std::ptrdiff_t>(std::min(most, near.size()));
    std::partial_sort(near.begin(), last, near.end());
    for (auto s = near.begin(); s != last; ++s)
        if (s->second != nearest && !divided(point, s->second)) return s->second;
    return nearest;
}

}  // namespace

std::vector<std::uint32_t> nearest_sites(const std::vector<glm::dvec3>& points,
                                         const std::vector<glm::dvec3>& sites,
                                         const Divided& divided) {
    const Nearest nearest(sites);
    std::vector<std::uint32_t> owner(points.size()), members(sites.size());
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        owner[i] = last = nearest(points[i], last);
        const auto point = static_cast<std::uint32_t>(i);
        if (divided && divided(point, last))
            owner[i] = undivided_site(point, points[i], sites, last, divided);
        ++members[owner[i]];
    }
    for (std::uint32_t s = 0; s < sites.size(); ++s) {
        if (members[s] > 0) continue;
        const std::uint32_t point = spare_point(points, sites[s], owner, members);
        --members[owner[point]];
        owner[point] = s;
        members[s] = 1;
    }
    return owner;
}

}  // namespace clgi
