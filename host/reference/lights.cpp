// SPDX-License-Identifier: MIT
#include "reference/lights.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

double power(const Geometry& geometry, std::uint32_t index) {
    const Material& material = geometry.materials[geometry.triangles[index].material];
    return area(geometry, index) * double{luminance(material.emission)} *
           (material.double_sided ? 2.0 : 1.0);
}

std::vector<std::uint32_t> emissive(const Geometry& geometry) {
    std::vector<std::uint32_t> out;
    for (std::uint32_t t = 0; t < geometry.triangles.size(); ++t)
        if (power(geometry, t) > 0.0) out.push_back(t);
    return out;
}

std::vector<LightTree::Item> items(const Geometry& geometry,
                                   const std::vector<std::uint32_t>& triangles) {
    std::vector<LightTree::Item> out;
    for (const std::uint32_t t : triangles) {
        glm::vec3 corners[3];
        for (int k = 0; k < 3; ++k)
            corners[k] = geometry.positions[geometry.triangles[t].vertex[k]];
        const glm::vec3 centre = (corners[0] + corners[1] + corners[2]) / 3.0f;
        float radius = 0.0f;
        for (const glm::vec3& corner : corners)
            radius = std::max(radius, glm::distance(centre, corner));
        out.push_back({centre, radius, power(geometry, t)});
    }
    return out;
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
    : geometry_(geometry),
      lamps_(scene.lights),
      areas_(emissive(geometry)),
      emissive_(geometry.triangles.size(), none),
      tree_(items(geometry, areas_)) {
    for (Light& lamp : lamps_) lamp.direction = glm::normalize(lamp.direction);
    for (const Light& lamp : lamps_) lamp_positions_.push_back(geometry.to_local(lamp.position));
    for (std::uint32_t k = 0; k < areas_.size(); ++k) emissive_[areas_[k]] = k;
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
    const std::uint32_t place = tree_.sample(point, random);
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
    out.from += surface.lift * surface.geometric;
    out.irradiance = surface.emission / out.density;
    return out;
}

float Lights::density(const Hit& hit, const glm::vec3& point) const {
    if (emissive_[hit.triangle] == none) return 0.0f;
    const float share = tree_.probability(emissive_[hit.triangle], point);
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
