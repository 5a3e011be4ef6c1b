// SPDX-License-Identifier: MIT
#include "scene/sky_cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "scene/environment.hpp"
#include "scene/luminance.hpp"

namespace clgi {

using std::numbers::pi;

namespace {

struct Found {
    int cell;
    double within;  // the cell, [0,1]
};

// Of `count` cells the one in which a share of their power is reached; before(k): the power of
// those before cell k.
template <typename Before>
Found find_cell(int count, double share, const Before& before) {
    const double target = share * before(count);
    int low = 0, high = count;
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        (before(middle) <= target ? low : high) = middle;
    }
    const double first = before(low), here = before(low + 1) - first;
    return {low, here > 0.0 ? std::clamp((target - first) / here, 0.0, 1.0) : 0.5};
}

}  // namespace

SkyCells::SkyCells(const Environment& environment, const SkyWeights& weights)
    : picture_(with_picture(environment)),
      weights_(weights),
      across_((255 + picture_.width) / picture_.width),
      down_((127 + picture_.height) / picture_.height),
      sums_(std::size_t(width() + 1) * std::size_t(height() + 1), 0.0) {
    for (int column = 0; column < width(); ++column)
        round_.push_back(environment_direction(picture_, (column + 0.5) / width(), 0.5));
    const auto stride = static_cast<std::size_t>(width() + 1);
    for (int row = 0; row < height(); ++row) {
        solid_angle_.push_back(texel_solid_angle(width(), height(), row));
        double* const sums = sums_.data() + static_cast<std::size_t>(row + 1) * stride + 1;
        double of_row = 0.0;
        for (int column = 0; column < width(); ++column) {
            of_row += power(row, column);
            sums[column] = *(sums + column - stride) + of_row;
        }
    }
}

glm::dvec3 SkyCells::light(int row, int column) const {
    const auto texel =
        static_cast<std::size_t>(row / down_) * static_cast<std::size_t>(picture_.width) +
        static_cast<std::size_t>(column / across_);
    return glm::dvec3(picture_.texels[texel]) * glm::dvec3(picture_.factor) *
           solid_angle_[static_cast<std::size_t>(row)];
}

double SkyCells::power(int row, int column) const {
    const double level = luminance(light(row, column));
    if (weights_.values.empty()) return level;
    const auto y = static_cast<std::size_t>(std::int64_t{row} * weights_.rows / height());
    const auto x = static_cast<std::size_t>(std::int64_t{column} * weights_.columns / width());
    return level * double{weights_.values[y * static_cast<std::size_t>(weights_.columns) + x]};
}

double SkyCells::power(int top, int bottom, int left, int right) const {
    const auto at = [&](int row, int column) {
        return sums_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width() + 1) +
                     static_cast<std::size_t>(column)];
    };
    return at(bottom, right) - at(top, right) - at(bottom, left) + at(top, left);
}

SkyCells::Patch SkyCells::patch(int top, int bottom, int left, int right) const {
    return {top, bottom, left, right, power(top, bottom, left, right)};
}

SkyLight SkyCells::light_of(const Patch& patch) const {
    glm::dvec3 sum(0.0), centre(0.0);
    for (int row = patch.top; row < patch.bottom; ++row) {
        glm::dvec3 level(0.0);
        double power = 0.0;
        for (int column = patch.left; column < patch.right; ++column) {
            const glm::dvec3 here = light(row, column);
            sum += here;
            power += luminance(here);
            level += luminance(here) * round_[static_cast<std::size_t>(column)];
        }
        const double down = pi * (row + 0.5) / height();
        centre += level * std::sin(down) + glm::dvec3(0, power * std::cos(down), 0);
    }
    const double length = glm::length(centre);
    // An even sky as one light has no centre.
    return {length > 1e-6 * luminance(sum) ? centre / length : glm::dvec3(0, 1, 0), sum};
}

SkyLight SkyCells::drawn(glm::dvec2 at) const {
    const Found down =
        find_cell(height(), at.y, [&](int row) { return power(0, row, 0, width()); });
    const Found across = find_cell(
        width(), at.x, [&](int column) { return power(down.cell, down.cell + 1, 0, column); });
    // Even in solid angle within the cell.
    const double top = std::cos(pi * down.cell / height()),
                 bottom = std::cos(pi * (down.cell + 1) / height());
    const double v = std::acos(std::clamp(top + down.within * (bottom - top), -1.0, 1.0)) / pi;
    const double level = power(down.cell, across.cell);
    if (!(level > 0.0)) return {glm::dvec3(0, 1, 0), glm::dvec3(0.0)};
    const double all = power(0, height(), 0, width());
    return {environment_direction(picture_, (across.cell + across.within) / width(), v),
            light(down.cell, across.cell) * (all / level)};
}

}  // namespace clgi
