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
#include "scene/local_frame.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr double wished_tests = 5e6, fewest_paths = 32.0, most_paths = 256.0;
constexpr std::size_t surfaces = 3;       // of a path
constexpr double held = 0.9;              // of the points, by the sphere
constexpr double beyond = 1.5;            // what else may light them
constexpr std::size_t area_points = 512;  // that measure its area
constexpr std::size_t lamp_points = 32, sight_lines = 16;

// Of the scene, what the picture reaches: below these it is a small part of it.
constexpr double small_size = 0.125, small_area = 0.1, small_power = 0.5;

struct Place {
    glm::dvec3 position;  // local
    glm::dvec3 normal;    // towards where the path came from
    std::size_t triangle = 0;
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
                       glm::dot(normal, along[i]) > 0.0 ? -normal : normal, rays.triangle(i)});
    }
    return out;
}

double at(std::size_t i, std::uint32_t base) {
    return radical_inverse(static_cast<std::uint32_t>(i) + 1, base);
}

// All places that paths meet, those first that the picture shows.
struct Met {
    std::vector<Place> places;
    std::size_t shown = 0;
    double open = 0.0;  // share of the directions followed from them that leave the scene
};

Met met(const LocalScene& local, const Camera& camera, int width, int height) {
    const SceneFrame& frame = local.frame;
    const double wished = wished_tests / static_cast<double>(std::max<std::size_t>(
                                             surfaces * local.triangles.size(), 1));
    const auto paths = static_cast<std::size_t>(std::clamp(wished, fewest_paths, most_paths));
    const View view = make_view(camera, frame, width, height);
    Met out;
    std::vector<Place> places;
    std::vector<glm::dvec3> along;
    std::size_t followed = 0, left = 0;
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
        const std::size_t from = places.size();
        places = ends(rays, places, along, local);
        if (depth == 0) {
            out.shown = places.size();
        } else {
            followed += from;
            left += from - places.size();
        }
        along.clear();
        for (std::size_t i = 0; i < places.size(); ++i) {
            out.places.push_back(places[i]);
            along.push_back(
                about(places[i].normal, at(i, depth == 0 ? 5 : 11), at(i, depth == 0 ? 7 : 13)));
        }
    }
    if (followed > 0) out.open = static_cast<double>(left) / static_cast<double>(followed);
    return out;
}

// Local; a quarter of what is shown lies nearer.
double pixel_size(const Met& found, const Camera& camera, const SceneFrame& frame, int height) {
    if (found.shown == 0) return 0.0;
    const glm::dvec3 eye = (camera.position - frame.origin) * frame.scale;
    std::vector<double> depths;
    for (std::size_t i = 0; i < found.shown; ++i)
        depths.push_back(glm::dot(found.places[i].position - eye, glm::dvec3(camera.forward)));
    const auto quarter = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 4);
    std::nth_element(depths.begin(), quarter, depths.end());
    const bool parallel = camera.kind == Camera::Kind::orthographic;
    return (parallel ? 2.0 * double{camera.half_height} * frame.scale
                     : 2.0 * std::tan(0.5 * double{camera.vertical_fov}) * *quarter) /
           height;
}

// Of what is shown.
double shown_gloss(const Scene& scene, const Met& found) {
    double sum = 0.0;
    for (std::size_t i = 0; i < found.shown; ++i) {
        const Material& material =
            scene.materials[scene.triangles[found.places[i].triangle].material];
        const Reflectance shares = reflectance(material);
        const double base = luminance(glm::dvec3(material.base_color));
        const double gloss = base * double{shares.lobe} + double{shares.coat};
        const double all = gloss + base * double{shares.diffuse};
        if (all > 0.0) sum += gloss / all * (gloss / all);
    }
    return found.shown > 0 ? std::sqrt(sum / static_cast<double>(found.shown)) : 0.0;
}

double radius_of_share(const std::vector<Place>& places, const glm::dvec3& centre, double share) {
    std::vector<double> distances;
    for (const Place& place : places) distances.push_back(glm::distance(place.position, centre));
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

// Whether nothing lies between a lamp and a place that faces it. normal: of the lamp's surface, or
// 0.
class SightLines {
public:
    void add(const glm::dvec3& from, const glm::dvec3& normal, const Place& to, std::size_t lamp) {
        const double distance = glm::distance(to.position, from);
        const glm::dvec3 along = (to.position - from) / std::max(distance, same_place);
        const bool faces = normal == glm::dvec3(0.0) || glm::dot(along, normal) > 0.0;
        if (!(distance > 4.0 * same_place) || !faces || !(glm::dot(along, to.normal) < 0.0)) return;
        rays_.add(from, along, distance - 2.0 * same_place, Rays::any);
        lamps_.push_back(lamp);
    }

    // By lamp: whether a place sees it.
    std::vector<bool> seen(const LocalScene& local, std::size_t lamps) {
        rays_.trace(local.blockers);
        std::vector<bool> out(lamps, false);
        for (std::size_t r = 0; r < lamps_.size(); ++r)
            if (!rays_.met(r)) out[lamps_[r]] = true;
        return out;
    }

private:
    Rays rays_;
    std::vector<std::size_t> lamps_;
};

const Place& place_at(const std::vector<Place>& places, std::size_t lamp, std::size_t line) {
    return places[(lamp * sight_lines + line * 7919) % places.size()];
}

// Of emissive surfaces, the share of their power that some place sees. emits: [triangles]
double seen_share(const LocalScene& local, const std::vector<double>& emits,
                  const std::vector<Place>& places) {
    const std::vector<SurfacePoint> points = surface_points(local.triangles, emits, lamp_points);
    SightLines lines;
    for (std::size_t i = 0; i < points.size(); ++i)
        for (std::size_t k = 0; k < sight_lines; ++k)
            lines.add(points[i].position, points[i].normal, place_at(places, i, k), i);
    const std::vector<bool> seen = lines.seen(local, points.size());
    double all = 0.0, some = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        all += emits[points[i].triangle];
        some += seen[i] ? emits[points[i].triangle] : 0.0;
    }
    return share(some, all);
}

// What the lamps that light the places send, of all.
struct Lamps {
    double power = 0.0, reached = 0.0;  // lumen; reached: in the sphere, or seen by a place
    double area = 0.0;                  // local, of emissive surfaces in the sphere
    double hidden = 0.0;                // share of the power of these that no place sees
};

Lamps lamps_of(const Scene& scene, const LocalScene& local, const std::vector<Place>& places,
               const glm::dvec3& centre, double radius) {
    Lamps out;
    const SceneFrame& frame = local.frame;
    const auto inside = [&](const glm::dvec3& place) {
        return glm::distance(place, centre) <= radius;
    };
    std::vector<double> outside;  // lumen
    SightLines lines;
    for (const Light& light : scene.lights) {
        if (light.kind == Light::Kind::directional) continue;
        const double power = 4.0 * std::numbers::pi * luminance(light.intensity);
        const glm::dvec3 at = (light.position - frame.origin) * frame.scale;
        out.power += power;
        if (inside(at)) {
            out.reached += power;
            continue;
        }
        for (std::size_t k = 0; k < sight_lines; ++k)
            lines.add(at, glm::dvec3(0.0), place_at(places, outside.size(), k), outside.size());
        outside.push_back(power);
    }
    const std::vector<bool> seen = lines.seen(local, outside.size());
    for (std::size_t i = 0; i < outside.size(); ++i) out.reached += seen[i] ? outside[i] : 0.0;

    std::vector<double> near(local.triangles.size(), 0.0), far = near;
    double near_power = 0.0, far_power = 0.0;
    for (std::size_t i = 0; i < local.lights.emissive.size(); ++i) {
        const std::uint32_t t = local.lights.emissive[i];
        const LocalTriangle& one = local.triangles[t];
        const double radiance = local.lights.radiance[i];
        if (one.is_line()) continue;
        const double power = std::numbers::pi * radiance * one.area / (frame.scale * frame.scale);
        if (inside((one.corners[0] + one.corners[1] + one.corners[2]) / 3.0)) {
            near[t] = radiance;
            near_power += power;
            out.area += one.area;
        } else {
            far[t] = radiance;
            far_power += power;
        }
    }
    out.power += near_power + far_power;
    out.reached += near_power;
    if (near_power > 0.0) out.hidden = 1.0 - seen_share(local, near, places);
    if (far_power > 0.0) out.reached += far_power * seen_share(local, far, places);
    return out;
}

// Metres; of spots that are nearly half-spaces, as of narrower ones.
double widest_cone(const Scene& scene, const glm::dvec3& centre) {
    constexpr double most = 1.3;  // radians
    double out = 0.0;
    for (const Light& light : scene.lights)
        if (light.kind == Light::Kind::spot && luminance(light.intensity) > 0.0f)
            out = std::max(out, 2.0 * glm::distance(light.position, centre) *
                                    std::tan(std::min(double{light.outer_angle}, most)));
    return out;
}

}  // namespace

Reach reach_of(const Scene& scene, const LocalScene& local, const Camera& camera, int width,
               int height) {
    const auto start = timing::Clock::now();
    Reach out;
    const SceneFrame& frame = local.frame;
    const Met found = met(local, camera, width, height);
    const std::vector<Place>& places = found.places;
    out.pixel = pixel_size(found, camera, frame, height) / frame.scale;
    out.points = places.size();
    out.open = found.open;
    out.gloss = shown_gloss(scene, found);
    out.sphere = {frame.origin, frame.radius / frame.scale};
    if (places.empty()) return out;
    // The middle of those that are not far away, so that a few places behind a window do not draw
    // it away from the room.
    const glm::dvec3 eye = (camera.position - frame.origin) * frame.scale;
    const double near = radius_of_share(places, eye, held);
    glm::dvec3 sum(0.0);
    double count = 0.0;
    for (const Place& place : places)
        if (glm::distance(place.position, eye) <= near) {
            sum += place.position;
            count += 1.0;
        }
    const glm::dvec3 centre = sum / count;
    const double radius = std::max(radius_of_share(places, centre, held), 2.0 * same_place);
    out.sphere = {frame.origin + centre / frame.scale, radius / frame.scale};
    out.size = radius / double{frame.radius};
    out.cone = widest_cone(scene, out.sphere.centre);
    out.area = share_of_area(local.triangles, centre, beyond * radius);
    const Lamps lamps = lamps_of(scene, local, places, centre, beyond * radius);
    out.power = share(lamps.reached, lamps.power);
    out.emissive_area = lamps.area / (frame.scale * frame.scale);
    out.hidden = lamps.hidden;
    out.milliseconds = timing::milliseconds(timing::Clock::now() - start);
    return out;
}

std::optional<Focus> focus_of(const Reach& reach) {
    if (reach.size >= small_size && reach.area >= small_area && reach.power >= small_power)
        return std::nullopt;
    return Focus{reach.sphere.centre, 2.0 * reach.sphere.radius};
}

SunMaps sun_maps(const Reach& reach) {
    const double whole = reach.sphere.radius / reach.size;
    const std::optional<Focus> focus = focus_of(reach);
    if (!focus || !(focus->radius < small_focus * whole)) return {1, whole};
    return {2, focus->radius};
}

}  // namespace clgi
