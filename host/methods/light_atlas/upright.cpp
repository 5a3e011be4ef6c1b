// A side of the smallest rectangle around points lies along a side of their convex hull.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "methods/light_atlas/flatten.hpp"

namespace clgi {
namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

glm::dvec2 across(const glm::dvec2& along) { return {-along.y, along.x}; }

// Counter-clockwise; without the points within its sides.
std::vector<glm::dvec2> convex_hull(std::vector<glm::dvec2> points) {
    const auto before = [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    };
    std::sort(points.begin(), points.end(), before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 3) return points;
    std::vector<glm::dvec2> hull;
    const auto walk = [&](auto first, auto last) {
        const std::size_t start = hull.size();
        for (; first != last; ++first) {
            while (hull.size() >= start + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], *first - hull.back()) <= 0.0)
                hull.pop_back();
            hull.push_back(*first);
        }
        hull.pop_back();  // the next walk begins there
    };
    walk(points.begin(), points.end());
    walk(points.rbegin(), points.rend());
    return hull;
}

}  // namespace

glm::dvec2 turn_upright(std::vector<glm::dvec2>& corners) {
    const std::vector<glm::dvec2> hull = convex_hull(corners);
    glm::dvec2 best(1.0, 0.0);
    double least = -1.0;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const glm::dvec2 side = hull[(i + 1) % hull.size()] - hull[i];
        const double length = glm::length(side);
        if (!(length > 0.0)) continue;
        const glm::dvec2 along = side / length, up = across(along);
        glm::dvec2 low(1e300), high(-1e300);
        for (const glm::dvec2& point : hull) {
            const glm::dvec2 turned(glm::dot(point, along), glm::dot(point, up));
            low = glm::min(low, turned);
            high = glm::max(high, turned);
        }
        const double area = (high.x - low.x) * (high.y - low.y);
        // The first of equal ones, whatever the last digit says.
        if (least < 0.0 || area < least * (1.0 - 1e-9)) {
            least = area;
            best = high.x - low.x >= high.y - low.y ? along : up;
        }
    }
    const glm::dvec2 up = across(best);
    glm::dvec2 low(1e300), high(-1e300);
    for (glm::dvec2& corner : corners) {
        corner = {glm::dot(corner, best), glm::dot(corner, up)};
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    for (glm::dvec2& corner : corners) corner -= low;
    return high - low;
}

}  // namespace clgi
