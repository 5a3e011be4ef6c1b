// SPDX-License-Identifier: MIT
#include <numbers>

#include "plan/moving_parts.hpp"
#include "plan/parts.hpp"
#include "scene/emission.hpp"
#include "scene/environment.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr double pi = std::numbers::pi;

bool has_power(const Light& light) { return luminance(light.intensity) > 0.0f; }

void add_lights(const Scene& scene, LightFacts& out) {
    for (const Light& light : scene.lights) {
        if (!has_power(light)) continue;
        switch (light.kind) {
            case Light::Kind::point:
                ++out.points;
                break;
            case Light::Kind::spot:
                ++out.spots;
                break;
            case Light::Kind::directional:
                ++out.directional;
                break;
        }
    }
    if (!scene.animation) return;
    const MovingParts parts = moving_parts(*scene.animation);
    for (const Carried& carried : scene.animation->lights)
        if (parts.nodes[carried.node] != 0 && has_power(scene.lights[carried.index]))
            out.moving = true;
}

}  // namespace

LightsFound light_facts(const Scene& scene) {
    LightsFound out;
    LightFacts& facts = out.facts;
    add_lights(scene, facts);
    const EmissionMeans emission(scene);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const SceneTriangle& triangle = scene.triangles[t];
        const double radiance = luminance(emission(triangle));
        const double area = triangle_area(scene, triangle);
        if (!(radiance > 0.0) || !(area > 0.0)) continue;
        const double sides = scene.materials[triangle.material].double_sided ? 2.0 : 1.0;
        out.emissive.push_back(t);
        ++facts.emissive_triangles;
        facts.emissive_area += area;
        facts.emissive_power += pi * radiance * area * sides;
    }
    if (scene.environment) {
        facts.environment_mean = luminance(environment_fluence(*scene.environment)) / (4.0 * pi);
        facts.environment = facts.environment_mean > 0.0;
    }
    return out;
}

}  // namespace clgi
