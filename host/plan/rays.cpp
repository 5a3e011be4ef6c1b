// SPDX-License-Identifier: MIT
#include "plan/rays.hpp"

#include <algorithm>
#include <limits>

namespace clgi {
namespace {

// On barycentric coordinates: rays do not slip between neighbours.
constexpr double edge = 1e-12;
constexpr std::size_t block = 32;   // triangles that one box is around
constexpr double box_slack = 1e-9;  // for rounding, of the scene's radius

}  // namespace

void Rays::add(const glm::dvec3& from, const glm::dvec3& along, double longest, Search search) {
    for (int k = 0; k < 3; ++k) {
        from_[k].push_back(from[k]);
        along_[k].push_back(along[k]);
        // A huge number in place of infinity: 0 times it is 0.
        per_along_[k].push_back(1.0 / (along[k] == 0.0 ? 1e-300 : along[k]));
    }
    nearest_.push_back(longest);
    met_.push_back(nothing);
    search_.push_back(search);
    triangle_.push_back(0);
}

void Rays::choose(const LocalTriangle* first, const LocalTriangle* last) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const LocalTriangle* t = first; t != last; ++t)
        for (const glm::dvec3& corner : t->corners) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    low -= box_slack;
    high += box_slack;
    chosen_.clear();
    for (std::size_t i = 0; i < count(); ++i) {
        double enter = 0.0, leave = nearest_[i];
        for (int k = 0; k < 3; ++k) {
            const double a = (low[k] - from_[k][i]) * per_along_[k][i];
            const double b = (high[k] - from_[k][i]) * per_along_[k][i];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (enter <= leave) chosen_.push_back(i);
    }
}

// [Moeller and Trumbore 1997], the determinant by the triangle's normal.
void Rays::meet(const LocalTriangle& triangle, std::uint32_t index) {
    const glm::dvec3 &a = triangle.corners[0], e1 = triangle.corners[1] - a,
                     e2 = triangle.corners[2] - a, n = glm::cross(e1, e2);
    for (const std::size_t i : chosen_) {
        const double dx = along_[0][i], dy = along_[1][i], dz = along_[2][i];
        const double ox = from_[0][i] - a.x, oy = from_[1][i] - a.y, oz = from_[2][i] - a.z;
        const double facing = -(n.x * dx + n.y * dy + n.z * dz);
        const double over = 1.0 / facing;  // infinite for rays along the plane: no hit
        const double distance = (n.x * ox + n.y * oy + n.z * oz) * over;
        const double cx = oy * dz - oz * dy, cy = oz * dx - ox * dz, cz = ox * dy - oy * dx;
        const double u = (e2.x * cx + e2.y * cy + e2.z * cz) * over;
        const double v = -(e1.x * cx + e1.y * cy + e1.z * cz) * over;
        const bool hit = u >= -edge && v >= -edge && u + v <= 1.0 + edge && distance > same_place &&
                         distance < nearest_[i];
        if (!hit) continue;
        nearest_[i] =
            search_[i] == any ? -1.0 : distance;  // before all boxes: it is not asked again
        met_[i] = facing < 0.0 && !triangle.double_sided ? back : front;
        triangle_[i] = index;
    }
}

void Rays::trace(const std::vector<LocalTriangle>& triangles) {
    for (std::size_t first = 0; first < triangles.size(); first += block) {
        const std::size_t last = std::min(first + block, triangles.size());
        choose(&triangles[first], triangles.data() + last);
        for (std::size_t t = first; t < last && !chosen_.empty(); ++t)
            if (!triangles[t].is_line()) meet(triangles[t], static_cast<std::uint32_t>(t));
    }
}

}  // namespace clgi
