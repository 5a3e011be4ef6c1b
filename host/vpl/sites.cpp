// SPDX-License-Identifier: MIT
#include "vpl/sites.hpp"

#include "vpl/nearest.hpp"

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

}  // namespace

std::vector<std::uint32_t> nearest_sites(const std::vector<glm::dvec3>& points,
                                         const std::vector<glm::dvec3>& sites) {
    const Nearest nearest(sites);
    std::vector<std::uint32_t> owner(points.size()), members(sites.size());
    std::uint32_t last = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        owner[i] = last = nearest(points[i], last);
        ++members[last];
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
