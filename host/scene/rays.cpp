// SPDX-License-Identifier: MIT
#include "scene/rays.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace clgi {
namespace {

// On barycentric coordinates: rays do not slip between neighbours.
constexpr double edge = 1e-12;
constexpr double box_slack = 1e-9;  // for rounding, of the scene's radius

// Calls with the first element of every block and the one after its last.
template <typename Work>
void for_blocks(std::size_t count, const Work& work) {
    for (std::size_t first = 0; first < count; first += Blockers::block)
        work(first, std::min(first + Blockers::block, count));
}

Blockers::Box no_box() {
    const glm::dvec3 low(std::numeric_limits<double>::infinity());
    return {low, -low};
}

}  // namespace

Blockers::Blockers(const std::vector<LocalTriangle>& triangles) : triangles_(triangles) {
    for_blocks(triangles.size(), [&](std::size_t first, std::size_t last) {
        Box& box = boxes_.emplace_back(no_box());
        for (std::size_t t = first; t < last; ++t)
            for (const glm::dvec3& corner : triangles[t].corners) {
                box.low = glm::min(box.low, corner);
                box.high = glm::max(box.high, corner);
            }
        box.low -= box_slack;
        box.high += box_slack;
    });
    for_blocks(boxes_.size(), [&](std::size_t first, std::size_t last) {
        Box& box = larger_.emplace_back(no_box());
        for (std::size_t b = first; b < last; ++b) {
            box.low = glm::min(box.low, boxes_[b].low);
            box.high = glm::max(box.high, boxes_[b].high);
        }
    });
}

void Rays::add(const glm::dvec3& from, const glm::dvec3& along, double longest, Search search) {
    for (int k = 0; k < 3; ++k) {
        from_[k].push_back(from[k]);
        along_[k].push_back(along[k]);
        // A huge number in place of infinity: 0 times it is 0.
        per_along_[k].push_back(1.0 / (along[k] == 0.0 ? 1e-300 : along[k]));
    }
    nearest_.push_back(longest);
    met_.push_back(0);
    search_.push_back(search);
    triangle_.push_back(0);
}

// Those that pass through a box before what they have met.
void Rays::choose(const Blockers::Box& box, const Chosen& of, Chosen& out) const {
    out.clear();
    for (const std::uint32_t i : of) {
        double enter = 0.0, leave = nearest_[i];
        for (int k = 0; k < 3; ++k) {
            const double a = (box.low[k] - from_[k][i]) * per_along_[k][i];
            const double b = (box.high[k] - from_[k][i]) * per_along_[k][i];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (enter <= leave) out.push_back(i);
    }
}

// [Moeller and Trumbore 1997], the determinant by the triangle's normal.
void Rays::meet(const LocalTriangle& triangle, std::uint32_t index, const Chosen& rays) {
    const glm::dvec3 &a = triangle.corners[0], e1 = triangle.corners[1] - a,
                     e2 = triangle.corners[2] - a, n = glm::cross(e1, e2);
    for (const std::uint32_t i : rays) {
        const double dx = along_[0][i], dy = along_[1][i], dz = along_[2][i];
        const double ox = from_[0][i] - a.x, oy = from_[1][i] - a.y, oz = from_[2][i] - a.z;
        const double facing = -(n.x * dx + n.y * dy + n.z * dz);
        const double before = n.x * ox + n.y * oy + n.z * oz;
        if (!(before * facing > 0.0)) continue;  // the plane lies behind the ray or along it
        const double over = 1.0 / facing, distance = before * over;
        if (!(distance > same_place && distance < nearest_[i])) continue;
        const double cx = oy * dz - oz * dy, cy = oz * dx - ox * dz, cz = ox * dy - oy * dx;
        const double u = (e2.x * cx + e2.y * cy + e2.z * cz) * over;
        const double v = -(e1.x * cx + e1.y * cy + e1.z * cz) * over;
        if (!(u >= -edge && v >= -edge && u + v <= 1.0 + edge)) continue;
        nearest_[i] =
            search_[i] == any ? -1.0 : distance;  // before all boxes: it is not asked again
        met_[i] = 1;
        triangle_[i] = index;
    }
}

void Rays::trace(const Blockers& blockers) {
    const std::vector<LocalTriangle>& triangles = blockers.triangles();
    Chosen all(nearest_.size()), some, few;
    std::iota(all.begin(), all.end(), 0u);
    for_blocks(blockers.boxes().size(), [&](std::size_t first, std::size_t end) {
        choose(blockers.larger()[first / Blockers::block], all, some);
        for (std::size_t box = first; box < end && !some.empty(); ++box) {
            choose(blockers.boxes()[box], some, few);
            const std::size_t last = std::min((box + 1) * Blockers::block, triangles.size());
            for (std::size_t t = box * Blockers::block; t < last && !few.empty(); ++t)
                if (!triangles[t].is_line()) meet(triangles[t], static_cast<std::uint32_t>(t), few);
        }
    });
}

}  // namespace clgi
