// SPDX-License-Identifier: MIT
#include "plan/reach.hpp"

#include <clgi/shared/halton.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/opencl/timing.hpp"
#include "plan/about.hpp"
#include "plan/surface_points.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr double wished_tests = 5e6, fewest_paths = 32.0, most_paths = 256.0;
constexpr std::size_t surfaces = 3;       // of a path
constexpr double held = 0.9;              // of the points, by the sphere
constexpr double beyond = 1.5;            // what else may light them
constexpr std::size_t area_points = 512;  // that measure its area
constexpr std::size_t lamp_points = 32, sight_lines = 16;

struct Place {
    glm::dvec3 position;  // local
    glm::dvec3 normal;    // towards where the path came from
};

// Where rays end; those that leave the scene do not.
std::vector<Place> ends(Rays& rays, const std::vector<Place>& from,
                        const std::vector<glm::dvec3>& along, const LocalScene& local) {
    for (std::size_t i = 0; i < from.size(); ++i)
        rays.add(from[i].position, along[i], std::numeric_limits<double>::infinity());
    rays.trace(local.blockers);
    std::vector<Place> out;
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (!rays.met(i)) continue;
        const glm::dvec3 normal = local.triangles[rays.triangle(i)].normal;
        out.push_back({from[i].position + rays.distance(i) * along[i],
                       glm::dot(normal, along[i]) > 0.0 ? -normal : normal});
    }
    return out;
}

double at(std::size_t i, std::uint32_t base) {
    return radical_inverse(static_cast<std::uint32_t>(i) + 1, base);
}

// All places that paths meet, local.
std::vector<glm::dvec3> met(const LocalScene& local, const Camera& camera, int width, int height) {
    const SceneFrame& frame = local.frame;
    const double wished = wished_tests / static_cast<double>(std::max<std::size_t>(
                                             surfaces * local.triangles.size(), 1));
    const auto paths = static_cast<std::size_t>(std::clamp(wished, fewest_paths, most_paths));
    const View view = make_view(camera, frame, width, height);
    std::vector<Place> places;
    std::vector<glm::dvec3> along, out;
    for (std::size_t i = 0; i < paths; ++i) {
        const double x = 2.0 * at(i, 2) - 1.0, y = 2.0 * at(i, 3) - 1.0;
        const glm::dvec3 across = x * double{view.right.w} * glm::dvec3(camera.right) +
                                  y * double{view.up.w} * glm::dvec3(camera.up);
        const bool parallel = view.eye.w != 0.0f;
        const glm::dvec3 eye = (camera.position - frame.origin) * frame.scale;
        places.push_back({parallel ? eye + across : eye, glm::dvec3(camera.forward)});
        along.push_back(
            glm::normalize(glm::dvec3(camera.forward) + (parallel ? glm::dvec3(0.0) : across)));
    }
    for (std::size_t depth = 0; depth < surfaces && !places.empty(); ++depth) {
        Rays rays;
        places = ends(rays, places, along, local);
        along.clear();
        for (std::size_t i = 0; i < places.size(); ++i) {
            out.push_back(places[i].position);
            along.push_back(
                about(places[i].normal, at(i, depth == 0 ? 5 : 11), at(i, depth == 0 ? 7 : 13)));
        }
    }
    return out;
}

double radius_of_share(const std::vector<glm::dvec3>& places, const glm::dvec3& centre,
                       double share) {
    std::vector<double> distances;
    for (const glm::dvec3& place : places) distances.push_back(glm::distance(place, centre));
    const auto rank = static_cast<std::ptrdiff_t>(share * static_cast<double>(places.size() - 1));
    std::nth_element(distances.begin(), distances.begin() + rank, distances.end());
    return distances[static_cast<std::size_t>(rank)];
}

double share(double some, double all) { return all > 0.0 ? some / all : 1.0; }

double share_of_area(const std::vector<LocalTriangle>& triangles, const glm::dvec3& centre,
                     double radius) {
    const auto points =
        surface_points(triangles, std::vector<double>(triangles.size(), 1.0), area_points);
    const auto inside = std::count_if(points.begin(), points.end(), [&](const SurfacePoint& one) {
        return glm::distance(one.position, centre) <= radius;
    });
    return share(static_cast<double>(inside), static_cast<double>(points.size()));
}

// Lamps, and which of the emissive triangles lie in the sphere.
struct Lamps {
    double power = 0.0, inside = 0.0;  // lumen
    std::vector<double> emits;         // [triangles] of those inside: radiance, cd/m^2
    double area = 0.0;                 // local, of these
};

Lamps lamps_of(const Scene& scene, const LocalScene& local, const glm::dvec3& centre,
               double radius) {
    Lamps out;
    const SceneFrame& frame = local.frame;
    const auto add = [&](double power, const glm::dvec3& place) {
        const bool inside = glm::distance(place, centre) <= radius;
        out.power += power;
        out.inside += inside ? power : 0.0;
        return inside;
    };
    for (const Light& light : scene.lights)
        if (light.kind != Light::Kind::directional)
            add(4.0 * std::numbers::pi * luminance(light.intensity),
                (light.position - frame.origin) * frame.scale);
    const double square = frame.scale * frame.scale;
    out.emits.assign(local.triangles.size(), 0.0);
    for (std::size_t i = 0; i < local.lights.emissive.size(); ++i) {
        const std::uint32_t t = local.lights.emissive[i];
        const LocalTriangle& one = local.triangles[t];
        if (one.is_line()) continue;
        const double radiance = local.lights.radiance[i];
        if (!add(std::numbers::pi * radiance * one.area / square,
                 (one.corners[0] + one.corners[1] + one.corners[2]) / 3.0))
            continue;
        out.emits[t] = radiance;
        out.area += one.area;
    }
    return out;
}

// Points on lamps that none of the places sees, by power.
double hidden_share(const LocalScene& local, const Lamps& lamps,
                    const std::vector<glm::dvec3>& places) {
    if (!(lamps.area > 0.0)) return 0.0;
    const std::vector<SurfacePoint> points =
        surface_points(local.triangles, lamps.emits, lamp_points);
    Rays rays;
    std::vector<std::size_t> owner;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < sight_lines; ++k) {
            const glm::dvec3 to = places[(i * sight_lines + k * 7919) % places.size()];
            const double distance = glm::distance(to, points[i].position);
            const glm::dvec3 along = (to - points[i].position) / std::max(distance, same_place);
            if (!(distance > 4.0 * same_place) || !(glm::dot(along, points[i].normal) > 0.0))
                continue;
            rays.add(points[i].position, along, distance - 2.0 * same_place, Rays::any);
            owner.push_back(i);
        }
    rays.trace(local.blockers);
    std::vector<bool> seen(points.size(), false);
    for (std::size_t r = 0; r < owner.size(); ++r)
        if (!rays.met(r)) seen[owner[r]] = true;
    double all = 0.0, hidden = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double power = lamps.emits[points[i].triangle];
        all += power;
        hidden += seen[i] ? 0.0 : power;
    }
    return all > 0.0 ? hidden / all : 0.0;
}

}  // namespace

Reach reach_of(const Scene& scene, const LocalScene& local, const Camera& camera, int width,
               int height) {
    const auto start = timing::Clock::now();
    Reach out;
    const SceneFrame& frame = local.frame;
    const std::vector<glm::dvec3> places = met(local, camera, width, height);
    out.points = places.size();
    out.sphere = {frame.origin, frame.radius / frame.scale};
    if (places.empty()) return out;
    // The middle of those that are not far away, so that a few places behind a window do not draw
    // it away from the room.
    const glm::dvec3 eye = (camera.position - frame.origin) * frame.scale;
    const double near = radius_of_share(places, eye, held);
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for (const glm::dvec3& place : places)
        if (glm::distance(place, eye) <= near) {
            sum += place;
            count += 1.0;
        }
    const glm::dvec3 centre = sum / count;
    const double radius = std::max(radius_of_share(places, centre, held), 2.0 * same_place);
    out.sphere = {frame.origin + centre / frame.scale, radius / frame.scale};
    out.size = radius / double{frame.radius};
    out.area = share_of_area(local.triangles, centre, beyond * radius);
    const Lamps lamps = lamps_of(scene, local, centre, beyond * radius);
    out.power = share(lamps.inside, lamps.power);
    out.emissive_area = lamps.area / (frame.scale * frame.scale);
    out.hidden = hidden_share(local, lamps, places);
    out.milliseconds = timing::milliseconds(timing::Clock::now() - start);
    return out;
}

}  // namespace clgi
