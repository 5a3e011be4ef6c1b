// SPDX-License-Identifier: MIT
#include "plan/surroundings.hpp"

#include <clgi/shared/halton.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "plan/about.hpp"
#include "plan/rays.hpp"
#include "plan/surface_points.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr double wished_tests = 5e6;
constexpr double fewest_points = 64.0, most_points = 1024.0;
constexpr std::size_t most_seekers = 256;  // points that look for lights and walls
constexpr double most_lights = 16.0;       // for each of them
constexpr double grazing = 1e-3;           // cosine: light that comes in below it does not count
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Way {
    glm::dvec3 along;  // unit
    double distance;   // infinity: to a direction
};

std::optional<Way> way_to(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 way = to - from;
    const double distance = glm::length(way);
    if (!(distance > same_place)) return std::nullopt;
    return Way{way / distance, distance};
}

// From a point to a light, if that sends something there where nothing is between.
std::optional<Way> way_to(const Light& light, const SceneFrame& frame, const glm::dvec3& from) {
    if (light.kind == Light::Kind::directional)
        return Way{-glm::normalize(glm::dvec3(light.direction)), infinity};
    const std::optional<Way> way = way_to(from, (light.position - frame.origin) * frame.scale);
    if (!way) return way;
    if (light.range > 0.0f && way->distance >= double{light.range} * frame.scale)
        return std::nullopt;
    const double along = -glm::dot(way->along, glm::normalize(glm::dvec3(light.direction)));
    if (light.kind == Light::Kind::spot && along <= std::cos(double{light.outer_angle}))
        return std::nullopt;
    return way;
}

// The lights that points look for: of those with power at most so many, and emissive surfaces.
class Lights {
public:
    // All but emissive must outlive this object. at_most: lights that a point looks for.
    Lights(const std::vector<Light>& all, const SceneFrame& frame,
           const std::vector<LocalTriangle>& triangles, const std::vector<std::uint32_t>& emissive,
           std::size_t at_most)
        : frame_(frame), at_most_(at_most) {
        std::vector<double> emits(triangles.size(), 0.0);
        for (const std::uint32_t t : emissive) emits[t] = 1.0;
        emitters_ = surface_points(triangles, emits, most_seekers);
        for (const Light& light : all)
            if (luminance(light.intensity) > 0.0f) lights_.push_back(&light);
    }

    // Calls add(way) for each light that a point may be met by.
    template <typename Add>
    void each(const SurfacePoint& point, std::size_t number, const Add& add) const {
        const auto look = [&](const std::optional<Way>& way) {
            if (way && glm::dot(point.normal, way->along) > grazing) add(*way);
        };
        const auto at = [&](std::uint32_t base) {
            return double{radical_inverse(static_cast<std::uint32_t>(number) + 1, base)};
        };
        const auto all = static_cast<double>(lights_.size());
        const std::size_t count = std::min(lights_.size(), at_most_);
        for (std::size_t k = 0; k < count; ++k) {  // one of each of so many equal parts
            const double part = (static_cast<double>(k) + (count < lights_.size() ? at(7) : 0.0)) /
                                static_cast<double>(count);
            look(way_to(*lights_[static_cast<std::size_t>(part * all + 1e-9)], frame_,
                        point.position));
        }
        if (emitters_.empty()) return;
        const SurfacePoint& emitter =
            emitters_[static_cast<std::size_t>(at(5) * static_cast<double>(emitters_.size()))];
        const std::optional<Way> way = way_to(point.position, emitter.position);
        if (way && glm::dot(emitter.normal, way->along) < -grazing) look(way);
    }

private:
    const SceneFrame& frame_;
    const std::size_t at_most_;
    std::vector<const Light*> lights_;
    std::vector<SurfacePoint> emitters_;
};

double share(std::size_t some, std::size_t all) {
    return all > 0 ? static_cast<double>(some) / static_cast<double>(all) : 0.0;
}

// What rays that belong together begin with, and how many they are.
struct Run {
    std::size_t first = 0, count = 0;
};

void add_lit(const Rays& rays, const std::vector<Run>& to_lights, Surroundings& out) {
    std::size_t once = 0, twice = 0;
    for (const Run& run : to_lights) {
        std::size_t lights = 0;
        for (std::size_t i = run.first; i < run.first + run.count; ++i)
            lights += rays.met(i) ? 0 : 1;
        once += lights > 0 ? 1 : 0;
        twice += lights > 1 ? 1 : 0;
    }
    out.lit = share(once, to_lights.size());
    out.lit_twice = share(twice, once);
}

// A wall ends where a ray into it comes out of the back of a surface.
void add_thickness(const Rays& rays, const Run& into, double thin, Surroundings& out) {
    std::size_t thinner = 0;
    double least = infinity;
    for (std::size_t i = into.first; i < into.first + into.count; ++i) {
        if (!rays.met_back(i)) continue;
        least = std::min(least, rays.distance(i));
        thinner += rays.distance(i) < thin ? 1 : 0;
    }
    out.thin = share(thinner, into.count);
    out.thinnest = least < infinity ? least : 0.0;
}

}  // namespace

Surroundings survey(const std::vector<Light>& lights, const SceneFrame& frame,
                    const std::vector<LocalTriangle>& triangles, const std::vector<double>& weights,
                    const std::vector<std::uint32_t>& emissive,
                    const SurroundingsOptions& options) {
    const double requested =
        wished_tests / static_cast<double>(std::max<std::size_t>(triangles.size(), 1));
    auto count = static_cast<std::size_t>(std::clamp(requested, fewest_points, most_points));
    if (!options.open) count = std::min(count, most_seekers);
    const std::vector<SurfacePoint> points = surface_points(triangles, weights, count);
    Surroundings out;
    out.points = points.size();
    if (points.empty()) return out;

    Rays rays;
    if (options.open)
        for (std::uint32_t i = 0; i < points.size(); ++i)
            rays.add(points[i].position,
                     about(points[i].normal, radical_inverse(i + 1, 5), radical_inverse(i + 1, 7)),
                     infinity);
    const Run open{0, rays.count()};
    const std::size_t few = std::min(count, most_seekers);
    std::vector<double> single = weights;
    for (std::size_t t = 0; t < single.size(); ++t)
        if (triangles[t].double_sided) single[t] = 0.0;
    for (const SurfacePoint& point : surface_points(triangles, single, few))
        rays.add(point.position, -point.normal, infinity);
    const Run into{open.count, rays.count() - open.count};
    const auto lights_each =
        std::clamp(4.0 * requested / static_cast<double>(few), 1.0, most_lights);
    const Lights sources(lights, frame, triangles, emissive, static_cast<std::size_t>(lights_each));
    std::vector<Run> to_lights;
    for (const SurfacePoint& point : surface_points(triangles, weights, few)) {
        const std::size_t first = rays.count();
        sources.each(point, to_lights.size(), [&](const Way& way) {
            rays.add(point.position, way.along, way.distance - same_place, Rays::any);
        });
        to_lights.push_back({first, rays.count() - first});
    }
    rays.trace(triangles);

    std::size_t missed = 0, backs = 0;
    for (std::size_t i = 0; i < open.count; ++i) {
        missed += rays.met(i) ? 0 : 1;
        backs += rays.met_back(i) ? 1 : 0;
    }
    out.open = options.open ? share(missed, open.count) : 1.0;
    out.backs = share(backs, open.count);
    add_lit(rays, to_lights, out);
    add_thickness(rays, into, options.thin, out);
    return out;
}

}  // namespace clgi
