// Two cases in which nothing lies between a light and a point that it lights. [derived]
//
//   inside    all planes support, and the light is strictly on the scene's side of each: what lies
//             on those sides is convex and has triangles on its boundary alone
//   before    no vertex lies strictly on the light's side of the lit triangle's plane
//
// Alpha is not read: a masked or blended triangle counts as whole.
// SPDX-License-Identifier: MIT
#include "plan/proof.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "plan/supporting.hpp"
#include "scene/local_frame.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

// Triangles that are looked at first: where anything stands in the room, one of them shows it, and
// a large scene need not be sorted.
constexpr std::size_t samples = 256;

// A light in the local frame. Of a directional light only the direction towards it counts, and it
// lies before planes that face it, wherever they are.
struct Source {
    glm::dvec3 place;  // or the unit vector to the light
    bool directional;
    double rounding;  // of its distance from a plane

    double before(const Plane& plane) const {
        return directional ? glm::dot(plane.normal, place) : plane.distance(place);
    }
};

std::vector<Source> sources_of(const Scene& scene) {
    const SceneFrame frame = local_frame(bounds(scene));
    std::vector<Source> out;
    for (const Light& light : scene.lights) {
        if (!(luminance(light.intensity) > 0.0f)) continue;
        if (light.kind == Light::Kind::directional) {
            // The direction and the normals of planes are rounded.
            out.push_back({-glm::normalize(glm::dvec3(light.direction)), true, 2.0 * same_place});
            continue;
        }
        const glm::dvec3 place = (light.position - frame.origin) * frame.scale;
        const double far = std::max({1.0, std::abs(place.x), std::abs(place.y), std::abs(place.z)});
        out.push_back({place, false, same_place * far});
    }
    return out;
}

constexpr double flat_cosine = 0.99985;  // of a degree

// Whether the normals of vertices are those of their triangles.
bool shaded_flat(const Scene& scene, const std::vector<LocalTriangle>& triangles) {
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        if (triangles[t].is_line()) continue;
        for (const std::uint32_t vertex : scene.triangles[t].vertex)
            if (!(glm::dot(glm::dvec3(scene.normals[vertex]), triangles[t].normal) >= flat_cosine))
                return false;
    }
    return true;
}

class Prover {
public:
    Prover(const Scene& scene, const std::vector<LocalTriangle>& triangles)
        : scene_(scene),
          sources_(sources_of(scene)),
          triangles_(triangles),
          planes_(triangles),
          step_(std::max<std::size_t>(triangles.size() / samples, 1)) {}

    OpennessProof prove(const std::vector<std::uint32_t>& emissive) {
        OpennessProof out;
        out.surfaces_open = surfaces_open();
        out.surfaces_apart =
            out.surfaces_open && std::all_of(order().begin(), order().end(), [&](std::uint32_t t) {
                return triangles_[t].is_line() || sees_nothing(t);
            });
        out.environment_open = out.surfaces_apart && shaded_flat(scene_, triangles_);
        out.lights_open = lights_open(out.surfaces_open, emissive);
        return out;
    }

private:
    // Large ones first: their planes are told best, and others lie in them.
    const std::vector<std::uint32_t>& order() {
        if (!order_.empty()) return order_;
        order_.resize(triangles_.size());
        std::iota(order_.begin(), order_.end(), 0u);
        std::stable_sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return triangles_[a].area > triangles_[b].area;
        });
        return order_;
    }

    // Whether one of the samples that are wanted stands in the room. Found once for each.
    template <typename Wanted>
    bool any_crossed(const Wanted& wanted) {
        crossed_.resize(triangles_.size() / step_ + 1);
        for (std::size_t t = 0; t < triangles_.size(); t += step_) {
            if (triangles_[t].is_line() || !wanted(t)) continue;
            std::optional<bool>& crossed = crossed_[t / step_];
            if (!crossed) crossed = planes_.crossed(t);
            if (*crossed) return true;
        }
        return false;
    }

    bool surfaces_open() {
        if (any_crossed([](std::size_t) { return true; })) return false;
        for (const std::uint32_t t : order())
            if (!triangles_[t].is_line() && !planes_.place(t)) return false;
        // Lines have no plane, but must not stand in the room.
        for (const std::uint32_t t : order())
            if (triangles_[t].is_line() && !planes_.in_a_plane(triangles_[t])) return false;
        return !planes_.overlap();
    }

    bool sees_nothing(std::uint32_t t) {
        const auto& placed = planes_.place(t);
        return placed && !placed->before && !(triangles_[t].double_sided && placed->behind);
    }

    bool lights_open(bool surfaces_open, const std::vector<std::uint32_t>& emissive) {
        for (const Source& source : sources_)
            if (!(surfaces_open && inside(source)) && !before_all(source)) return false;
        if (surfaces_open) return true;  // between points of emissive surfaces and others as well
        for (const std::uint32_t t : emissive)
            if (triangles_[t].is_line() || !sees_nothing(t)) return false;
        return !planes_.overlap();
    }

    bool inside(const Source& source) const {
        // Along a plane light from far away stays on its side; a place on it may be behind it.
        const double least = source.directional ? -source.rounding : source.rounding;
        for (const SupportingPlanes::Supporting& known : planes_.planes()) {
            const double before = source.before(known.plane);
            if (known.sides.above && !(before >= least)) return false;
            if (known.sides.below && !(-before >= least)) return false;
        }
        return true;
    }

    bool before_all(const Source& source) {
        const auto lit_sides = [&](std::size_t t) {  // front, back
            const LocalTriangle& triangle = triangles_[t];
            const Plane plane{triangle.normal, glm::dot(triangle.normal, triangle.corners[0])};
            const double before = source.before(plane);
            return std::pair(before >= -source.rounding,
                             triangle.double_sided && before <= source.rounding);
        };
        const auto lit_at_all = [&](std::size_t t) {
            const auto [lit, lit_behind] = lit_sides(t);
            return lit || lit_behind;
        };
        if (any_crossed(lit_at_all)) return false;
        for (const std::uint32_t t : order()) {
            if (triangles_[t].is_line()) continue;
            const auto [lit, lit_behind] = lit_sides(t);
            if (!lit && !lit_behind) continue;
            const auto& placed = planes_.place(t);
            if (!placed || (lit && placed->before) || (lit_behind && placed->behind)) return false;
        }
        return true;
    }

    const Scene& scene_;
    std::vector<Source> sources_;
    const std::vector<LocalTriangle>& triangles_;
    SupportingPlanes planes_;
    std::size_t step_;                          // between samples
    std::vector<std::optional<bool>> crossed_;  // [samples] whether they stand in the room
    std::vector<std::uint32_t> order_;
};

}  // namespace

OpennessProof prove_openness(const Scene& scene, const std::vector<LocalTriangle>& triangles,
                             const std::vector<std::uint32_t>& emissive) {
    if (triangles.empty()) return {true, true, true, true};  // there is nothing at all
    return Prover(scene, triangles).prove(emissive);
}

}  // namespace clgi
