// Points of a spiral and their opposites, moved to the middles of their own cells a few times
// (Lloyd's method). A cell is cut out of the plane that touches the sphere at its point, by the
// planes half way to other points: a polygon whose solid angle has a closed form.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/direction_bins.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace clgi {
namespace {

constexpr int rounds = 30;  // solid angles then differ by 12 % from their mean, at most

using Polygon = std::vector<glm::dvec3>;

// What is left where dot(plane, x) >= 0.
Polygon cut(const Polygon& polygon, const glm::dvec3& plane) {
    Polygon out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3& a = polygon[i];
        const glm::dvec3& b = polygon[(i + 1) % polygon.size()];
        const double above = glm::dot(plane, a), next = glm::dot(plane, b);
        if (above >= 0.0) out.push_back(a);
        if ((above >= 0.0) != (next >= 0.0)) out.push_back(glm::mix(a, b, above / (above - next)));
    }
    return out;
}

// The corners of a point's cell, counter-clockwise seen from outside, not of unit length.
Polygon cell(const std::vector<glm::dvec3>& points, std::size_t of) {
    const glm::dvec3 w = points[of];
    const glm::dvec3 other = std::abs(w.z) < 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 s = glm::normalize(glm::cross(other, w)), t = glm::cross(w, s);
    Polygon out = {w - s - t, w + s - t, w + s + t, w - s + t};
    // A cell is no wider than about two spacings; points beyond four of them cut nothing off it.
    const double near = std::cos(std::min(
        4.0 * std::sqrt(4.0 * glm::pi<double>() / static_cast<double>(points.size())), 2.0));
    for (std::size_t i = 0; i < points.size(); ++i)
        if (i != of && glm::dot(points[i], w) > near) out = cut(out, w - points[i]);
    return out;
}

// The integral of the direction over the cell: half the sum of its edges' normals, each as long
// as the edge's angle.
glm::dvec3 middle(const Polygon& polygon) {
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const glm::dvec3 normal = glm::cross(a, b);
        const double sine = glm::length(normal);
        if (sine > 0.0) sum += std::atan2(sine, glm::dot(a, b)) / sine * normal;
    }
    return glm::normalize(sum);
}

// A fan of triangles at the first corner [Van Oosterom, Strackee: The Solid Angle of a Plane
// Triangle. IEEE Transactions on Biomedical Engineering 30, 1983].
double solid_angle(const Polygon& polygon) {
    double sum = 0.0;
    const glm::dvec3 a = glm::normalize(polygon[0]);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const glm::dvec3 b = glm::normalize(polygon[i]), c = glm::normalize(polygon[i + 1]);
        sum += 2.0 * std::atan2(glm::dot(a, glm::cross(b, c)),
                                1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
    }
    return sum;
}

}  // namespace

DirectionBins direction_bins(int count) {
    if (count < 32 || count > 4096 || count % 2 != 0)
        throw Error("direction_bins: count is " + std::to_string(count) +
                    ", an even number from 32 to 4096 needed");
    const auto half = static_cast<std::size_t>(count) / 2;
    const double turn = glm::pi<double>() * (3.0 - std::sqrt(5.0));
    std::vector<glm::dvec3> points(2 * half);
    const auto put = [&](std::size_t i, const glm::dvec3& w) {
        points[i] = w;
        points[i + half] = -w;
    };
    for (std::size_t i = 0; i < half; ++i) {
        const double z = 1.0 - (static_cast<double>(i) + 0.5) / static_cast<double>(half);
        const double r = std::sqrt(1.0 - z * z), angle = turn * static_cast<double>(i);
        put(i, {r * std::cos(angle), r * std::sin(angle), z});
    }
    for (int round = 0; round < rounds; ++round) {
        std::vector<glm::dvec3> moved(half);
        for (std::size_t i = 0; i < half; ++i) moved[i] = middle(cell(points, i));
        for (std::size_t i = 0; i < half; ++i) put(i, moved[i]);
    }
    DirectionBins out;
    out.solid_angles.resize(points.size());
    for (std::size_t i = 0; i < half; ++i)
        out.solid_angles[i] = out.solid_angles[i + half] = solid_angle(cell(points, i));
    out.directions = std::move(points);
    return out;
}

int DirectionBins::nearest(const glm::dvec3& direction) const {
    int best = 0;
    double most = -1.0;
    for (int i = 0; i < count() / 2; ++i) {
        const double along = glm::dot(directions[static_cast<std::size_t>(i)], direction);
        if (std::abs(along) <= most) continue;
        most = std::abs(along);
        best = along < 0.0 ? opposite(i) : i;
    }
    return best;
}

double DirectionBins::hemisphere_scale(const glm::dvec3& normal) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < directions.size(); ++i)
        sum += solid_angles[i] * std::max(0.0, glm::dot(normal, directions[i]));
    return glm::pi<double>() / sum;
}

}  // namespace clgi
