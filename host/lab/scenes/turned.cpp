// Surfaces of revolution and cushions. Vertices are shared along a ring, and between the rings of
// a smooth outline; where it bends sharply each side has its own, at the same place.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "lab/scenes/rigging.hpp"
#include "lab/scenes/solids.hpp"

namespace clgi::generated {
namespace {

constexpr double smooth_bend = 0.766;  // cosine of 40 degrees

glm::dvec2 left_of(const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 way = glm::normalize(to - from);
    return {way.y, -way.x};  // outward, of an outline that runs up
}

class Lathe {
public:
    Lathe(Scene& scene, const Placement& at, int sides, std::uint32_t material)
        : scene_(scene), at_(at), sides_(sides), material_(material) {}

    // A stretch of the outline, with the normals of its two ends.
    void band(const glm::dvec2& from, const glm::dvec2& to, const glm::dvec2& from_normal,
              const glm::dvec2& to_normal) {
        const std::uint32_t a = ring(from, from_normal), b = ring(to, to_normal);
        for (int side = 0; side < sides_; ++side) {
            const auto i = static_cast<std::uint32_t>(side);
            const auto k = static_cast<std::uint32_t>((side + 1) % sides_);
            if (from.x > 0.0) add(a + i, b + (to.x > 0.0 ? k : i), a + k);
            if (to.x > 0.0) add(a + i, b + i, b + k);
        }
    }

private:
    std::uint32_t ring(const glm::dvec2& place, const glm::dvec2& normal) {
        const auto first = static_cast<std::uint32_t>(scene_.positions.size());
        for (int side = 0; side < sides_; ++side) {
            // At the axis a vertex for each triangle, half a side on, so that it has its normal.
            const double on = place.x > 0.0 ? 0.0 : 0.5;
            const double angle = 2.0 * glm::pi<double>() * (side + on) / sides_;
            const double c = std::cos(angle), s = std::sin(angle);
            scene_.positions.push_back(at_({place.x * c, place.y, place.x * s}));
            scene_.normals.emplace_back(
                at_.axes * glm::normalize(glm::dvec3(normal.x * c, normal.y, normal.x * s)));
        }
        return first;
    }
    void add(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        scene_.triangles.push_back({{a, b, c}, material_});
    }

    Scene& scene_;
    const Placement& at_;
    int sides_;
    std::uint32_t material_;
};

double signed_power(double base, double exponent) {
    return std::copysign(std::pow(std::abs(base), exponent), base);
}

}  // namespace

void add_turned(Scene& scene, const Placement& at, const std::vector<TurnedRing>& outline,
                int sides, std::uint32_t material, Outline kind) {
    std::vector<glm::dvec2> points;
    for (const TurnedRing& ring : outline) points.emplace_back(ring.radius, ring.height);
    const bool loop = kind == Outline::loop;
    if (!loop && points.front().x > 0.0) points.insert(points.begin(), {0.0, points.front().y});
    if (!loop && points.back().x > 0.0) points.emplace_back(0.0, points.back().y);

    const std::size_t count = points.size(), bands = loop ? count : count - 1;
    std::vector<glm::dvec2> normals;
    for (std::size_t k = 0; k < bands; ++k)
        normals.push_back(left_of(points[k], points[(k + 1) % count]));
    // Of a band at its end towards another band.
    const auto blended = [&](std::size_t band, std::size_t other) {
        const glm::dvec2 &here = normals[band], &there = normals[other];
        return glm::dot(here, there) > smooth_bend ? glm::normalize(here + there) : here;
    };
    Lathe lathe(scene, at, sides, material);
    for (std::size_t k = 0; k < bands; ++k) {
        const bool first = k == 0 && !loop, last = k + 1 == bands && !loop;
        lathe.band(points[k], points[(k + 1) % count],
                   first ? normals[k] : blended(k, (k + bands - 1) % bands),
                   last ? normals[k] : blended(k, (k + 1) % bands));
    }
}

void add_rod(Scene& scene, const Placement& at, const glm::dvec3& from, const glm::dvec3& to,
             double radius, int sides, std::uint32_t material) {
    add_turned(scene, at(along(from, to - from)), {{radius, 0.0}, {radius, glm::length(to - from)}},
               sides, material);
}

void add_cushion(Scene& scene, const Placement& at, const glm::dvec3& half_size, double power,
                 int sides, int rings, std::uint32_t material) {
    const std::size_t first = scene.positions.size(), first_triangle = scene.triangles.size();
    const double exponent = 2.0 / power;
    const auto place = [&](double turn, double height) {
        const double around = signed_power(std::cos(height), exponent);
        return at(half_size * glm::dvec3(around * signed_power(std::cos(turn), exponent),
                                         signed_power(std::sin(height), exponent),
                                         around * signed_power(std::sin(turn), exponent)));
    };
    const double pi = glm::pi<double>();
    for (int ring = 1; ring < rings; ++ring)
        for (int side = 0; side < sides; ++side)
            scene.positions.push_back(
                place(2.0 * pi * side / sides, pi * (double(ring) / rings - 0.5)));
    scene.positions.push_back(at({0.0, -half_size.y, 0.0}));
    scene.positions.push_back(at({0.0, half_size.y, 0.0}));
    close_rings(scene, static_cast<std::uint32_t>(first), rings - 1, sides, material);
    smooth_normals_of(scene, first, first_triangle);
}

void smooth_normals_of(Scene& scene, std::size_t first, std::size_t first_triangle) {
    std::vector<glm::dvec3> sums(scene.positions.size() - first, glm::dvec3(0.0));
    for (std::size_t t = first_triangle; t < scene.triangles.size(); ++t) {
        const auto& [a, b, c] = scene.triangles[t].vertex;
        const glm::dvec3 twice = glm::cross(scene.positions[b] - scene.positions[a],
                                            scene.positions[c] - scene.positions[a]);
        for (const std::uint32_t vertex : {a, b, c}) sums[vertex - first] += twice;
    }
    scene.normals.resize(first);
    for (const glm::dvec3& sum : sums) scene.normals.emplace_back(glm::normalize(sum));
}

}  // namespace clgi::generated
