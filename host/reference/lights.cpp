// SPDX-License-Identifier: MIT
#include "reference/lights.hpp"

#include <algorithm>
#include <cmath>

#include "reference/material.hpp"
#include "reference/tracer.hpp"

namespace clgi::reference {
namespace {

double area(const Geometry& geometry, std::uint32_t index) {
    const SceneTriangle& triangle = geometry.triangles[index];
    const glm::dvec3 a(geometry.positions[triangle.vertex[0]]);
    return 0.5 * glm::length(glm::cross(glm::dvec3(geometry.positions[triangle.vertex[1]]) - a,
                                        glm::dvec3(geometry.positions[triangle.vertex[2]]) - a));
}

// KHR_lights_punctual: linear in the cosine between the two angles, then squared.
double cone_share(const Light& light, double cosine) {
    const double outer = std::cos(double{light.outer_angle});
    const double inner = std::cos(double{light.inner_angle});
    if (cosine >= inner) return 1.0;
    if (cosine < outer) return 0.0;
    const double t = (cosine - outer) / std::max(inner - outer, 1e-12);
    return t * t;
}

}  // namespace

Lights::Lights(const Scene& scene, const Geometry& geometry)
    : geometry_(geometry), lamps_(scene.lights), share_(geometry.triangles.size(), 0.0f) {
    for (Light& lamp : lamps_) lamp.direction = glm::normalize(lamp.direction);
    for (const Light& lamp : lamps_) lamp_positions_.push_back(geometry.to_local(lamp.position));
    double total = 0.0;
    for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t) {
        const Material& material = geometry.materials[geometry.triangles[t].material];
        const double power = area(geometry, t) * double{luminance(material.emission)} *
                             (material.double_sided ? 2.0 : 1.0);
        if (!(power > 0.0)) continue;
        areas_.push_back(t);
        cumulative_.push_back(total += power);
        share_[t] = static_cast<float>(power);
    }
    for (float& share : share_) share = static_cast<float>(total > 0.0 ? share / total : 0.0);
}

std::optional<Arrival> Lights::from_lamp(std::size_t index, const glm::vec3& point) const {
    const Light& lamp = lamps_[index];
    Arrival out;
    if (lamp.kind == Light::Kind::directional) {
        out.direction = -lamp.direction;
        out.from = beyond(point, out.direction);
        out.irradiance = lamp.intensity;
        return out;
    }
    const glm::dvec3 toward = glm::dvec3(lamp_positions_[index]) - glm::dvec3(point);
    const double distance = glm::length(toward);
    if (distance == 0.0) return std::nullopt;
    const double metres = distance / geometry_.scale;
    out.from = lamp_positions_[index];
    out.direction = glm::vec3(toward / distance);
    double share = 1.0 / (metres * metres);
    if (lamp.kind == Light::Kind::spot)
        share *= cone_share(lamp, -glm::dot(glm::dvec3(lamp.direction), toward / distance));
    if (lamp.range > 0.0f) share *= std::max(1.0 - std::pow(metres / double{lamp.range}, 4.0), 0.0);
    if (share <= 0.0) return std::nullopt;
    out.irradiance = glm::vec3(glm::dvec3(lamp.intensity) * share);
    return out;
}

std::optional<Arrival> Lights::from_surface(const glm::vec3& point, Random& random) const {
    const double at = double{random()} * cumulative_.back();
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), at);
    const std::size_t place = std::min<std::size_t>(found - cumulative_.begin(), areas_.size() - 1);
    const float root = std::sqrt(random());
    const float along = random();
    const Hit hit{areas_[place], root * (1.0f - along), root * along};
    if (!opaque(geometry_, hit, chance(geometry_, random))) return std::nullopt;
    const SceneTriangle& triangle = geometry_.triangles[hit.triangle];
    Arrival out;
    out.from = geometry_.positions[triangle.vertex[0]] * (1.0f - root) +
               geometry_.positions[triangle.vertex[1]] * hit.b1 +
               geometry_.positions[triangle.vertex[2]] * hit.b2;
    const glm::vec3 toward = out.from - point;
    const float distance = glm::length(toward);
    if (distance == 0.0f) return std::nullopt;
    out.direction = toward / distance;
    const Surface surface = surface_at(geometry_, hit, out.direction);
    out.density = density(hit, point);
    if (!surface.reflects || !(out.density > 0.0f)) return std::nullopt;
    out.from = off_surface(out.from, surface.geometric);
    out.irradiance = surface.emission / out.density;
    return out;
}

float Lights::density(const Hit& hit, const glm::vec3& point) const {
    const float share = share_[hit.triangle];
    if (share == 0.0f) return 0.0f;
    const SceneTriangle& triangle = geometry_.triangles[hit.triangle];
    const glm::vec3 position = geometry_.positions[triangle.vertex[0]] * (1.0f - hit.b1 - hit.b2) +
                               geometry_.positions[triangle.vertex[1]] * hit.b1 +
                               geometry_.positions[triangle.vertex[2]] * hit.b2;
    const glm::vec3 toward = position - point;
    const float square = glm::dot(toward, toward);
    const float cosine =
        std::abs(glm::dot(geometric_normal(geometry_, hit.triangle), toward)) / std::sqrt(square);
    if (!(cosine > 0.0f)) return 0.0f;
    return share / static_cast<float>(area(geometry_, hit.triangle)) * square / cosine;
}

}  // namespace clgi::reference
