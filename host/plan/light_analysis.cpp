// SPDX-License-Identifier: MIT
#include <algorithm>

#include "plan/parts.hpp"
#include "scene/emission.hpp"
#include "scene/environment.hpp"
#include "scene/luminance.hpp"
#include "scene/moving_parts.hpp"

namespace clgi {
namespace {

bool has_power(const Light& light) { return luminance(light.intensity) > 0.0f; }

void add_lights(const Scene& scene, LightAnalysis& out) {
    for (const Light& light : scene.lights) {
        const bool lit = has_power(light);
        switch (light.kind) {
            case Light::Kind::point:
                ++(lit ? out.points : out.dark_points);
                break;
            case Light::Kind::spot:
                ++(lit ? out.spots : out.dark_spots);
                break;
            case Light::Kind::directional:
                ++(lit ? out.directional : out.dark_directional);
                break;
        }
    }
    if (!scene.animation) return;
    const MovingParts parts = moving_parts(*scene.animation);
    for (const Carried& carried : scene.animation->lights)
        if (parts.nodes[carried.node] != 0 && has_power(scene.lights[carried.index]))
            out.moving = true;
}

// Whether some texel of a material emits.
bool emits(const Scene& scene, const Material& material) {
    if (!(luminance(material.emission) > 0.0f)) return false;
    if (material.emission_texture.texture < 0) return true;
    const auto& rgba =
        scene.textures[static_cast<std::size_t>(material.emission_texture.texture)].rgba;
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            if (rgba[i + c] > 0) return true;
    return false;
}

bool emits(const Scene& scene) {
    std::vector<bool> emitting(scene.materials.size());
    for (std::size_t m = 0; m < emitting.size(); ++m)
        emitting[m] = emits(scene, scene.materials[m]);
    return std::any_of(scene.triangles.begin(), scene.triangles.end(),
                       [&](const SceneTriangle& one) { return emitting[one.material]; });
}

}  // namespace

LightsFound light_analysis(const Scene& scene) {
    LightsFound out;
    LightAnalysis& analysis = out.analysis;
    add_lights(scene, analysis);
    analysis.emission = emits(scene);
    const EmissionMeans emission(scene);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const SceneTriangle& triangle = scene.triangles[t];
        const double radiance = luminance(emission(triangle));
        if (!(radiance > 0.0) || !(triangle_area(scene, triangle) > 0.0)) continue;
        out.emissive.push_back(t);
        out.radiance.push_back(radiance);
    }
    analysis.emissive_triangles = out.emissive.size();
    analysis.environment =
        scene.environment && luminance(environment_fluence(*scene.environment)) > 0.0;
    return out;
}

}  // namespace clgi
