// SPDX-License-Identifier: MIT
#include "plan/openness.hpp"

#include <clgi/shared/halton.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace clgi {
namespace {

constexpr double wished_tests = 5e6;
constexpr std::size_t fewest_rays = 64, most_rays = 1024;
// On barycentric coordinates: rays do not slip between neighbours.
constexpr double edge = 1e-12;
constexpr std::size_t block = 32;   // triangles that one box is around
constexpr double box_slack = 1e-9;  // for rounding, of the scene's radius

// Planes of rays, so that one triangle is compared with many.
struct Rays {
    std::vector<double> from[3], along[3], per_along[3];
    std::vector<double> nearest;        // distance, infinity: none
    std::vector<std::uint8_t> on_back;  // of the nearest
    std::size_t count() const { return nearest.size(); }
};

// A unit vector about n, its density in proportion to the cosine. [Malley's method]
glm::dvec3 about(const glm::dvec3& n, double u, double v) {
    const glm::dvec3 helper =
        std::abs(n.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 right = glm::normalize(glm::cross(n, helper));
    const glm::dvec3 up = glm::cross(n, right);
    const double radius = std::sqrt(u), angle = 2.0 * std::numbers::pi * v;
    return radius * std::cos(angle) * right + radius * std::sin(angle) * up +
           std::sqrt(1.0 - u) * n;
}

// Points by area: one in each of `count` equal parts of it, so that all large triangles have their
// share of points.
Rays make_rays(const std::vector<LocalTriangle>& triangles, const std::vector<double>& weights,
               std::size_t count) {
    std::vector<double> sums;  // of areas of sides
    double sum = 0.0;
    const bool any = std::any_of(weights.begin(), weights.end(), [](double w) { return w > 0.0; });
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const bool counts = (!any || weights[t] > 0.0) && !triangles[t].is_line();
        const double area = counts ? triangles[t].area : 0.0;
        sums.push_back(sum += area * (triangles[t].double_sided ? 2.0 : 1.0));
    }
    Rays out;
    if (!(sum > 0.0)) return out;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double target = (i + 0.5) / static_cast<double>(count) * sum;
        const auto found = std::upper_bound(sums.begin(), sums.end(), target);
        const auto t = static_cast<std::size_t>(std::min(found, sums.end() - 1) - sums.begin());
        const LocalTriangle& on = triangles[t];
        const double before = t > 0 ? sums[t - 1] : 0.0;
        const bool back = on.double_sided && target - before > on.area;
        const auto at = [&](std::uint32_t base) { return double{radical_inverse(i + 1, base)}; };
        const double root = std::sqrt(at(2)), v = at(3);
        const glm::dvec3 from = on.corners[0] * (1.0 - root) + on.corners[1] * (root * (1.0 - v)) +
                                on.corners[2] * (root * v);
        const glm::dvec3 along = about(back ? -on.normal : on.normal, at(5), at(7));
        for (int k = 0; k < 3; ++k) {
            out.from[k].push_back(from[k]);
            out.along[k].push_back(along[k]);
            // A huge number in place of infinity: 0 times it is 0.
            out.per_along[k].push_back(1.0 / (along[k] == 0.0 ? 1e-300 : along[k]));
        }
    }
    out.nearest.assign(count, std::numeric_limits<double>::infinity());
    out.on_back.assign(count, 0);
    return out;
}

// Rays that pass through the box of neighbouring triangles before what they have met.
void choose(const LocalTriangle* first, const LocalTriangle* last, const Rays& rays,
            std::vector<std::size_t>& chosen) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const LocalTriangle* t = first; t != last; ++t)
        for (const glm::dvec3& corner : t->corners) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    low -= box_slack;
    high += box_slack;
    chosen.clear();
    for (std::size_t i = 0; i < rays.count(); ++i) {
        double enter = 0.0, leave = rays.nearest[i];
        for (int k = 0; k < 3; ++k) {
            const double a = (low[k] - rays.from[k][i]) * rays.per_along[k][i];
            const double b = (high[k] - rays.from[k][i]) * rays.per_along[k][i];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (enter <= leave) chosen.push_back(i);
    }
}

// [Moeller and Trumbore 1997], the determinant by the triangle's normal. What lies in the place of
// the start, the own triangle above all, is not met.
void meet(const LocalTriangle& triangle, const std::vector<std::size_t>& chosen, Rays& rays) {
    const glm::dvec3 &a = triangle.corners[0], e1 = triangle.corners[1] - a,
                     e2 = triangle.corners[2] - a, n = glm::cross(e1, e2);
    for (const std::size_t i : chosen) {
        const double dx = rays.along[0][i], dy = rays.along[1][i], dz = rays.along[2][i];
        const double ox = rays.from[0][i] - a.x, oy = rays.from[1][i] - a.y,
                     oz = rays.from[2][i] - a.z;
        const double facing = -(n.x * dx + n.y * dy + n.z * dz);
        const double over = 1.0 / facing;  // infinite for rays along the plane: no hit
        const double distance = (n.x * ox + n.y * oy + n.z * oz) * over;
        const double cx = oy * dz - oz * dy, cy = oz * dx - ox * dz, cz = ox * dy - oy * dx;
        const double u = (e2.x * cx + e2.y * cy + e2.z * cz) * over;
        const double v = -(e1.x * cx + e1.y * cy + e1.z * cz) * over;
        const bool hit = u >= -edge && v >= -edge && u + v <= 1.0 + edge && distance > same_place &&
                         distance < rays.nearest[i];
        if (!hit) continue;
        rays.nearest[i] = distance;
        rays.on_back[i] = facing < 0.0 && !triangle.double_sided ? 1 : 0;
    }
}

}  // namespace

Openness estimate_openness(const std::vector<LocalTriangle>& triangles,
                           const std::vector<double>& weights) {
    const double wished =
        wished_tests / static_cast<double>(std::max<std::size_t>(triangles.size(), 1));
    Rays rays = make_rays(
        triangles, weights,
        static_cast<std::size_t>(std::clamp(wished, double{fewest_rays}, double{most_rays})));
    Openness out;
    if (rays.count() == 0) return out;
    std::vector<std::size_t> chosen;
    for (std::size_t first = 0; first < triangles.size(); first += block) {
        const std::size_t last = std::min(first + block, triangles.size());
        choose(&triangles[first], triangles.data() + last, rays, chosen);
        for (std::size_t t = first; t < last && !chosen.empty(); ++t)
            if (!triangles[t].is_line()) meet(triangles[t], chosen, rays);
    }
    const auto count = static_cast<double>(rays.count());
    const auto missed = static_cast<double>(std::count(rays.nearest.begin(), rays.nearest.end(),
                                                       std::numeric_limits<double>::infinity()));
    out.open = missed / count;
    // Of independent rays, which these even ones do better than. With one more ray of either kind,
    // so that a share of 0 or 1 is not taken for exact.
    const double share = (missed + 1.0) / (count + 2.0);
    out.open_error = std::sqrt(share * (1.0 - share) / count);
    out.backs =
        static_cast<double>(std::count(rays.on_back.begin(), rays.on_back.end(), 1)) / count;
    return out;
}

}  // namespace clgi
