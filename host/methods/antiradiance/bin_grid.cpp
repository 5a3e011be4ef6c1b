// SPDX-License-Identifier: MIT
#include "methods/antiradiance/bin_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clgi {
namespace {

constexpr double most_tests = 2e7;  // of a square and a bin
constexpr double rounding = 1e-7;   // radians, of angles near 0

// So many squares that few bins may be nearest in each; fewer where there are very many bins.
int side_for(int bins) {
    const double requested = std::min(2.0 * bins, most_tests / (1.5 * bins));
    return std::max(1, static_cast<int>(std::sqrt(requested)));
}

double angle_of(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

}  // namespace

BinGrid::BinGrid(const DirectionBins& bins, double farthest)
    : bins_(bins), side_(side_for(bins.count())) {
    std::vector<double> cosines(static_cast<std::size_t>(bins.count()) / 2);
    const auto append = [&](double angle, Lists& out) {
        const double reach = angle + rounding;
        const double least = reach < 0.5 * std::numbers::pi ? std::cos(reach) : 0.0;
        for (std::size_t i = 0; i < cosines.size(); ++i)
            if (cosines[i] >= least) out.bins.push_back(static_cast<std::uint16_t>(i));
        out.first.push_back(static_cast<std::uint32_t>(out.bins.size()));
    };
    for (int axis = 0; axis < 3; ++axis)
        for (int row = 0; row < side_; ++row)
            for (int column = 0; column < side_; ++column) {
                const auto at = [&](double x, double y) {
                    glm::dvec3 out(1.0);
                    out[(axis + 1) % 3] = 2.0 * (column + x) / side_ - 1.0;
                    out[(axis + 2) % 3] = 2.0 * (row + y) / side_ - 1.0;
                    return glm::normalize(out);
                };
                const glm::dvec3 middle = at(0.5, 0.5);
                double radius = 0.0;
                for (const double x : {0.0, 1.0})
                    for (const double y : {0.0, 1.0})
                        radius = std::max(radius, angle_of(glm::dot(middle, at(x, y))));
                for (std::size_t i = 0; i < cosines.size(); ++i)
                    cosines[i] = std::abs(glm::dot(middle, bins.directions[i]));
                const double nearest = *std::max_element(cosines.begin(), cosines.end());
                append(angle_of(nearest) + 2.0 * radius, nearest_);
                append(angle_of(farthest) + radius, around_);
            }
}

std::size_t BinGrid::square_of(const glm::dvec3& direction) const {
    const glm::dvec3 size = glm::abs(direction);
    const int axis = size.x >= size.y ? (size.x >= size.z ? 0 : 2) : (size.y >= size.z ? 1 : 2);
    const auto place = [&](int k) {
        const double at = (direction[k % 3] / direction[axis] + 1.0) * 0.5 * side_;
        return std::clamp(static_cast<int>(at), 0, side_ - 1);
    };
    return static_cast<std::size_t>((axis * side_ + place(axis + 2)) * side_ + place(axis + 1));
}

int BinGrid::nearest(const glm::dvec3& direction) const {
    int best = 0;
    double most = -1.0;
    for (const std::uint16_t i : nearest_.of(square_of(direction))) {
        const double along = glm::dot(bins_.directions[i], direction);
        if (std::abs(along) <= most) continue;
        most = std::abs(along);
        best = along < 0.0 ? bins_.opposite(i) : i;
    }
    return best;
}

}  // namespace clgi
