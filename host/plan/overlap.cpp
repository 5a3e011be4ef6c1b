// Pairs whose boxes meet along one axis of the plane, by a sweep along it; of each, whether a line
// along a side of either separates them. [derived: separating axes of convex polygons]
// SPDX-License-Identifier: MIT
#include "plan/overlap.hpp"

#include <algorithm>
#include <limits>

namespace clgi {
namespace {

using Flat = std::array<glm::dvec2, 3>;

struct Extent {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();
};

Extent along(const Flat& triangle, const glm::dvec2& axis) {
    Extent out;
    for (const glm::dvec2& corner : triangle) {
        out.low = std::min(out.low, glm::dot(axis, corner));
        out.high = std::max(out.high, glm::dot(axis, corner));
    }
    return out;
}

bool apart(const Extent& a, const Extent& b) {
    return std::min(a.high, b.high) - std::max(a.low, b.low) <= same_place;
}

// Whether a side of a separates the two.
bool side_separates(const Flat& a, const Flat& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec2 side = glm::normalize(a[(k + 1) % 3] - a[k]);
        const glm::dvec2 across(-side.y, side.x);
        if (apart(along(a, across), along(b, across))) return true;
    }
    return false;
}

}  // namespace

bool triangles_overlap(const std::vector<LocalTriangle>& triangles,
                       const std::vector<std::uint32_t>& chosen, const glm::dvec3& normal,
                       std::size_t& tests_left) {
    const glm::dvec3 helper =
        std::abs(normal.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 right = glm::normalize(glm::cross(normal, helper));
    const glm::dvec3 up = glm::cross(normal, right);
    struct Entry {
        Extent x, y;
        Flat corners;
    };
    std::vector<Entry> entries;
    for (const std::uint32_t index : chosen) {
        Entry& entry = entries.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec3& corner = triangles[index].corners[k];
            entry.corners[k] = {glm::dot(corner, right), glm::dot(corner, up)};
        }
        entry.x = along(entry.corners, {1.0, 0.0});
        entry.y = along(entry.corners, {0.0, 1.0});
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.x.low < b.x.low; });
    std::vector<const Entry*> open;  // that reach as far as the sweep has come
    for (const Entry& entry : entries) {
        if (open.size() > tests_left) return true;
        tests_left -= open.size();
        open.erase(std::remove_if(open.begin(), open.end(),
                                  [&](const Entry* other) {
                                      return other->x.high - entry.x.low <= same_place;
                                  }),
                   open.end());
        for (const Entry* other : open)
            if (!apart(other->x, entry.x) && !apart(other->y, entry.y) &&
                !side_separates(entry.corners, other->corners) &&
                !side_separates(other->corners, entry.corners))
                return true;
        open.push_back(&entry);
    }
    return false;
}

}  // namespace clgi
