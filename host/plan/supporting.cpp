// SPDX-License-Identifier: MIT
#include "plan/supporting.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "plan/overlap.hpp"

namespace clgi {
namespace {

constexpr std::size_t batch = 256;  // vertices between two looks at what was found
constexpr std::size_t few = 512;    // vertices that tell most planes apart from supporting ones
// Below this cosine a triangle that lies in a plane to within rounding does not tell its front.
constexpr double least_facing = 0.5;

// Every place once, neighbours far apart: a few of them then tell most about all.
std::vector<glm::dvec3> scattered_corners(const std::vector<LocalTriangle>& triangles) {
    std::vector<glm::dvec3> all;
    for (const LocalTriangle& triangle : triangles)
        all.insert(all.end(), triangle.corners.begin(), triangle.corners.end());
    const auto before = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    };
    std::sort(all.begin(), all.end(), before);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    const std::size_t count = all.size();
    auto stride = static_cast<std::size_t>(0.618 * static_cast<double>(count)) + 1;
    while (std::gcd(stride, count) != 1) ++stride;
    std::vector<glm::dvec3> out;
    for (std::size_t i = 0, at = 0; i < count; ++i, at = (at + stride) % count)
        out.push_back(all[at]);
    return out;
}

bool lies_in(const LocalTriangle& triangle, const Plane& plane) {
    return std::all_of(triangle.corners.begin(), triangle.corners.end(), [&](const glm::dvec3& p) {
        return std::abs(plane.distance(p)) <= same_place;
    });
}

}  // namespace

SupportingPlanes::SupportingPlanes(const std::vector<LocalTriangle>& triangles)
    : triangles_(triangles), states_(triangles.size(), State::unknown), placed_(triangles.size()) {
    const std::size_t step = std::max<std::size_t>(triangles.size() / few, 1);
    for (std::size_t t = 0; t < triangles.size(); t += step)
        few_.push_back(triangles[t].corners[t % 3]);
}

void SupportingPlanes::gather() {
    if (!x_.empty()) return;
    for (const glm::dvec3& p : scattered_corners(triangles_)) {
        x_.push_back(p.x);
        y_.push_back(p.y);
        z_.push_back(p.z);
    }
}

// A plane that holds the corners to within same_place is off the triangle's own by that and by
// what it tilts, over the smallest height; four times as much is beyond all of them.
bool SupportingPlanes::crossed(std::size_t triangle) const {
    const LocalTriangle& of = triangles_[triangle];
    const glm::dvec3& corner = of.corners[0];
    bool above = false, below = false;
    for (const glm::dvec3& p : few_) {
        const double distance = glm::dot(of.normal, p - corner);
        const double slack = 4.0 * same_place * (1.0 + glm::distance(p, corner) / of.height);
        above = above || distance > slack;
        below = below || distance < -slack;
        if (above && below) return true;
    }
    return false;
}

bool SupportingPlanes::spend(std::size_t tests) {
    if (tests > tests_left_) {
        tests_left_ = 0;
        return false;
    }
    tests_left_ -= tests;
    return true;
}

// Both where it was not found out: such a plane supports nothing.
Sides SupportingPlanes::sides_of(const Plane& plane) {
    Sides out;
    for (std::size_t first = 0; first < x_.size() && !(out.above && out.below); first += batch) {
        const std::size_t end = std::min(first + batch, x_.size());
        if (!spend(end - first)) return {true, true};
        double most = 0.0, least = 0.0;
        for (std::size_t v = first; v < end; ++v) {
            const double distance = plane.normal.x * x_[v] + plane.normal.y * y_[v] +
                                    plane.normal.z * z_[v] - plane.offset;
            most = std::max(most, distance);
            least = std::min(least, distance);
        }
        out.above = out.above || most > same_place;
        out.below = out.below || least < -same_place;
    }
    return out;
}

struct SupportingPlanes::Raised {
    Raised(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
        const glm::dvec3 across = glm::cross(b - a, c - a);
        centre = (a + b + c) / 3.0;
        height = glm::length(across) /
                 std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        plane.normal = glm::normalize(across);
        plane.offset = glm::dot(plane.normal, centre);
    }
    // By how much rounded corners may tilt it.
    double tilt() const { return point_rounding / height; }

    Plane plane;
    glm::dvec3 centre;
    double height;  // the smallest of the three corners
};

// Through the vertices that fix the same plane best, of those that may lie in it. Nothing if there
// are none that fix it better.
std::optional<SupportingPlanes::Raised> SupportingPlanes::refit(const Raised& from) {
    if (!spend(x_.size())) return std::nullopt;
    std::vector<glm::dvec3> near;
    for (std::size_t v = 0; v < x_.size(); ++v) {
        const glm::dvec3 p(x_[v], y_[v], z_[v]);
        const double slack = same_place + from.tilt() * glm::distance(p, from.centre);
        if (std::abs(from.plane.distance(p)) <= slack) near.push_back(p);
    }
    const auto farthest = [&](const auto& how_far) {
        return *std::max_element(
            near.begin(), near.end(),
            [&](const glm::dvec3& p, const glm::dvec3& q) { return how_far(p) < how_far(q); });
    };
    if (near.size() < 3) return std::nullopt;
    const glm::dvec3 a =
        farthest([&](const glm::dvec3& p) { return glm::distance(p, from.centre); });
    const glm::dvec3 b = farthest([&](const glm::dvec3& p) { return glm::distance(p, a); });
    const glm::dvec3 c =
        farthest([&](const glm::dvec3& p) { return glm::length(glm::cross(p - a, b - a)); });
    if (!(glm::length(glm::cross(c - a, b - a)) > 0.0)) return std::nullopt;
    Raised out(a, b, c);
    if (!(out.height > from.height)) return std::nullopt;
    if (glm::dot(out.plane.normal, from.plane.normal) < 0.0) {
        out.plane.normal = -out.plane.normal;
        out.plane.offset = -out.plane.offset;
    }
    return out;
}

// Rounding tilts the plane of a small triangle: over the size of the scene by more than
// same_place, so a wall of small triangles would not be flat. Any plane that holds the corners to
// within rounding is as good, so that of far vertices is taken where there is one.
Plane SupportingPlanes::fitted(const LocalTriangle& triangle) {
    const auto& [a, b, c] = triangle.corners;
    Raised best(a, b, c);
    for (int round = 0; round < 2; ++round) {
        if (2.0 * best.tilt() <= 0.5 * same_place) break;  // the local frame is 2 wide
        const std::optional<Raised> better = refit(best);
        if (!better || !lies_in(triangle, better->plane)) break;
        best = *better;
    }
    return best.plane;
}

std::optional<SupportingPlanes::Placed> SupportingPlanes::in_known_plane(std::size_t triangle) {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
        if (!spend(1)) return std::nullopt;
        Supporting& known = planes_[i];
        if (!lies_in(triangles_[triangle], known.plane)) continue;
        known.triangles.push_back(static_cast<std::uint32_t>(triangle));
        const double facing = glm::dot(known.plane.normal, triangles_[triangle].normal);
        const auto [above, below] = known.sides;
        if (facing > least_facing) return Placed{i, above, below};
        if (facing < -least_facing) return Placed{i, below, above};
        return Placed{i, above || below, above || below};
    }
    return std::nullopt;
}

std::optional<SupportingPlanes::Placed> SupportingPlanes::find(std::size_t triangle) {
    if (crossed(triangle)) return std::nullopt;
    if (const auto known = in_known_plane(triangle)) return known;
    gather();
    const LocalTriangle& of = triangles_[triangle];
    const Plane own{of.normal, glm::dot(of.normal, of.corners[0])};
    Plane plane = fitted(of);
    Sides sides = sides_of(plane);
    if (sides.above && sides.below) {
        plane = own;
        sides = sides_of(plane);
    }
    if (sides.above && sides.below) return std::nullopt;
    planes_.push_back({plane, sides, {}});
    return in_known_plane(triangle);
}

const std::optional<SupportingPlanes::Placed>& SupportingPlanes::place(std::size_t triangle) {
    if (states_[triangle] == State::unknown) {
        placed_[triangle] = find(triangle);
        states_[triangle] = State::known;
    }
    return placed_[triangle];
}

bool SupportingPlanes::in_a_plane(const LocalTriangle& triangle) const {
    return std::any_of(planes_.begin(), planes_.end(),
                       [&](const Supporting& known) { return lies_in(triangle, known.plane); });
}

bool SupportingPlanes::overlap() {
    for (const Supporting& known : planes_)
        if (triangles_overlap(triangles_, known.triangles, known.plane.normal, tests_left_))
            return true;
    return false;
}

}  // namespace clgi
