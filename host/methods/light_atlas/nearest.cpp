// SPDX-License-Identifier: MIT
#include "methods/light_atlas/nearest.hpp"

#include <algorithm>
#include <numeric>

namespace clgi {
namespace {
constexpr std::uint32_t leaf = 6;  // points that are tried one by one
}

Nearest::Nearest(const std::vector<glm::dvec3>& points)
    : points_(points), order_(points.size()), axis_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    build(0, static_cast<std::uint32_t>(order_.size()));
}

void Nearest::build(std::uint32_t first, std::uint32_t last) {
    if (last - first <= leaf) return;
    glm::dvec3 low = points_[order_[first]], high = low;
    for (std::uint32_t i = first; i < last; ++i) {
        low = glm::min(low, points_[order_[i]]);
        high = glm::max(high, points_[order_[i]]);
    }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = first + (last - first) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double x = points_[a][axis], y = points_[b][axis];
                         return x != y ? x < y : a < b;
                     });
    axis_[middle] = static_cast<std::uint8_t>(axis);
    build(first, middle);
    build(middle + 1, last);
}

void Nearest::search(std::uint32_t first, std::uint32_t last, const glm::dvec3& p,
                     Best& best) const {
    const auto attempt = [&](std::uint32_t point) {
        const glm::dvec3 d = points_[point] - p;
        const double squared = glm::dot(d, d);
        if (squared < best.squared || (squared == best.squared && point < best.point))
            best = {squared, point};
    };
    if (last - first <= leaf) {
        for (std::uint32_t i = first; i < last; ++i) attempt(order_[i]);
        return;
    }
    const std::uint32_t middle = first + (last - first) / 2;
    const int axis = axis_[middle];
    const double ahead = p[axis] - points_[order_[middle]][axis];
    attempt(order_[middle]);
    if (ahead < 0.0)
        search(first, middle, p, best);
    else
        search(middle + 1, last, p, best);
    if (ahead * ahead > best.squared) return;
    if (ahead < 0.0)
        search(middle + 1, last, p, best);
    else
        search(first, middle, p, best);
}

std::uint32_t Nearest::operator()(const glm::dvec3& p, std::uint32_t guess) const {
    const glm::dvec3 d = points_[guess] - p;
    Best best{glm::dot(d, d), guess};
    search(0, static_cast<std::uint32_t>(order_.size()), p, best);
    return best.point;
}

}  // namespace clgi
