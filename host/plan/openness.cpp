// SPDX-License-Identifier: MIT
#include "plan/openness.hpp"

#include <clgi/shared/halton.h>
#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/about.hpp"
#include "plan/surface_points.hpp"

namespace clgi {
namespace {

constexpr double wished_tests = 5e6;
constexpr double fewest_rays = 64.0, most_rays = 1024.0;
constexpr std::size_t first_look = 128;
constexpr double sure = 4.0;  // standard errors

double share_open(const std::vector<LocalTriangle>& triangles, const Blockers& blockers,
                  const std::vector<double>& weights, std::size_t count) {
    const std::vector<SurfacePoint> points = surface_points(triangles, weights, count);
    if (points.empty()) return 0.0;
    Rays rays;
    for (std::uint32_t i = 0; i < points.size(); ++i)
        rays.add(points[i].position,
                 about(points[i].normal, radical_inverse(i + 1, 5), radical_inverse(i + 1, 7)),
                 std::numeric_limits<double>::infinity(), Rays::any);
    rays.trace(blockers);
    std::size_t missed = 0;
    for (std::size_t i = 0; i < points.size(); ++i) missed += rays.met(i) ? 0 : 1;
    return static_cast<double>(missed) / static_cast<double>(points.size());
}

// Of independent rays, which these even ones do better than. With one more ray of either kind, so
// that a share of 0 or 1 is not taken for exact.
bool decides(double share, std::size_t count, const std::vector<double>& asked) {
    const auto rays = static_cast<double>(count);
    const double middle = (share * rays + 1.0) / (rays + 2.0);
    const double slack = sure * std::sqrt(middle * (1.0 - middle) / rays);
    return std::all_of(asked.begin(), asked.end(),
                       [&](double wanted) { return std::abs(share - wanted) > slack; });
}

}  // namespace

double openness(const std::vector<LocalTriangle>& triangles, const Blockers& blockers,
                const std::vector<double>& weights, const std::vector<double>& asked) {
    const double wished =
        wished_tests / static_cast<double>(std::max<std::size_t>(triangles.size(), 1));
    const auto most = static_cast<std::size_t>(std::clamp(wished, fewest_rays, most_rays));
    const std::size_t few = std::min(most, first_look);
    const double share = share_open(triangles, blockers, weights, few);
    if (few == most || decides(share, few, asked)) return share;
    return share_open(triangles, blockers, weights, most);
}

}  // namespace clgi
