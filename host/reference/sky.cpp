// SPDX-License-Identifier: MIT
#include "reference/sky.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/luminance.hpp"

namespace clgi::reference {
namespace {

constexpr double whole_turn = 2.0 * std::numbers::pi;

// Cosine of the angle from +Y at the upper edge of a row.
double edge(int row, int height) { return std::cos(std::numbers::pi * row / height); }

// [0,1), finer than one draw: a bright texel leaves little room for the others.
double fine(Random& random) { return double{random()} + double{random()} * 0x1p-24; }

// The first of rising sums to exceed a share of the last.
std::size_t drawn(const double* sums, std::size_t count, double share) {
    const double* found = std::upper_bound(sums, sums + count, share * sums[count - 1]);
    return std::min(static_cast<std::size_t>(found - sums), count - 1);
}

}  // namespace

Sky::Sky(const std::optional<Environment>& environment) : values_{glm::vec3(0.0f)} {
    if (environment) {
        width_ = std::max(environment->width, 1);
        height_ = std::max(environment->height, 1);
        turn_ = double{environment->rotation} / whole_turn;
        values_.assign(environment->texels.begin(), environment->texels.end());
        if (values_.empty()) values_.assign(1, glm::vec3(1.0f));
        for (glm::vec3& value : values_) value *= environment->factor;
    }
    double total = 0.0;
    for (int row = 0; row < height_; ++row) {
        const double solid_angle =
            (edge(row, height_) - edge(row + 1, height_)) * whole_turn / width_;
        double sum = 0.0;
        for (int column = 0; column < width_; ++column) {
            sum += luminance(glm::dvec3(values_[columns_.size()])) * solid_angle;
            columns_.push_back(sum);
        }
        rows_.push_back(total += sum);
    }
    shines_ = total > 0.0;
}

const glm::vec3& Sky::texel(const glm::vec3& direction) const {
    const glm::dvec3 d(direction);
    const double down = std::atan2(std::hypot(d.x, d.z), d.y) / std::numbers::pi;
    const double across = std::atan2(d.x, -d.z) / whole_turn + 0.5 + turn_;
    const auto at = [](double share, int size) {
        return static_cast<std::size_t>(std::clamp(static_cast<int>(share * size), 0, size - 1));
    };
    return values_[at(down, height_) * static_cast<std::size_t>(width_) +
                   at(across - std::floor(across), width_)];
}

glm::vec3 Sky::radiance(const glm::vec3& direction) const { return texel(direction); }

float Sky::density(const glm::vec3& direction) const {
    if (!shines_) return 0.0f;
    return static_cast<float>(luminance(glm::dvec3(texel(direction))) / rows_.back());
}

glm::vec3 Sky::sample(Random& random) const {
    const auto width = static_cast<std::size_t>(width_);
    const std::size_t row = drawn(rows_.data(), rows_.size(), fine(random));
    const std::size_t column = drawn(&columns_[row * width], width, fine(random));
    // Even in solid angle: in the cosine between the row's edges, and round.
    const double upper = edge(static_cast<int>(row), height_);
    const double lower = edge(static_cast<int>(row) + 1, height_);
    const double cosine = upper + (lower - upper) * double{random()};
    const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    const double across = (static_cast<double>(column) + double{random()}) / width_;
    const double angle = (across - 0.5 - turn_) * whole_turn;
    return {static_cast<float>(sine * std::sin(angle)), static_cast<float>(cosine),
            static_cast<float>(-sine * std::cos(angle))};
}

}  // namespace clgi::reference
