// SPDX-License-Identifier: MIT
#include "methods/antiradiance/spread_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clgi {
namespace {

using std::numbers::pi;

// Cosine of the half angle of a cone.
double edge_of_cone(double solid_angle) { return 1.0 - solid_angle / (2.0 * pi); }

std::vector<SpreadShare> make_row(const DirectionBins& bins, int middle, double solid_angle) {
    const auto direction = [&](int j) { return bins.directions[static_cast<std::size_t>(j)]; };
    const double variance = 4.0 * pi / bins.count(), edge = edge_of_cone(solid_angle);
    std::vector<SpreadShare> out;
    double sum = 0.0;
    for (int j = 0; j < bins.count(); ++j) {
        const double along = std::min(1.0, glm::dot(direction(j), direction(middle)));
        if (j != middle && along < edge) continue;
        const double angle = std::acos(along);
        const double weight = bins.solid_angles[static_cast<std::size_t>(j)] *
                              std::exp(-0.5 * angle * angle / variance);
        out.push_back({j, weight});
        sum += weight;
    }
    for (SpreadShare& share : out) share.weight /= sum;
    return out;
}

}  // namespace

SpreadTable::SpreadTable(const DirectionBins& bins) : mean_(4.0 * pi / bins.count()) {
    for (double cone = mean_; cone < 4.0 * pi; cone *= 2.0) {
        const double size = rows_.empty() ? 0.0 : std::min(cone, 2.0 * pi);
        auto& rows = rows_.emplace_back();
        for (int j = 0; j < bins.count(); ++j) rows.push_back(make_row(bins, j, size));
    }
}

const std::vector<SpreadShare>& SpreadTable::row(int bin, double solid_angle) const {
    std::size_t cone = 0;
    for (double size = mean_; size < solid_angle && cone + 1 < rows_.size(); size *= 2.0) ++cone;
    return rows_[cone][static_cast<std::size_t>(bin)];
}

}  // namespace clgi
