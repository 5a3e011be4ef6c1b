// SPDX-License-Identifier: MIT
#include <clgi/advanced/analysis.hpp>

#include <algorithm>
#include <cmath>

#include "core/opencl/timing.hpp"
#include "plan/local_triangles.hpp"
#include "plan/parts.hpp"
#include "plan/proof.hpp"
#include "plan/surroundings.hpp"
#include "scene/local_frame.hpp"

namespace clgi {
namespace {

constexpr double thin = 0.01;  // of the scene's size

void add_surroundings(const Scene& scene, const SceneFrame& frame,
                      const std::vector<LocalTriangle>& triangles,
                      const std::vector<TriangleAlbedo>& albedos,
                      const std::vector<std::uint32_t>& emissive, SceneAnalysis& out) {
    std::vector<double> reflects;
    reflects.reserve(albedos.size());
    for (const TriangleAlbedo& albedo : albedos)
        reflects.push_back(std::max({albedo.all.x, albedo.all.y, albedo.all.z}));
    const Surroundings found =
        survey(scene.lights, frame, triangles, reflects, emissive,
               {.thin = thin * out.size * frame.scale, .open = !out.proof.surfaces_apart});
    out.openness = out.proof.surfaces_apart ? 1.0 : found.open;
    out.backs = found.backs;
    out.lit = found.lit;
    out.lit_twice = found.lit_twice;
    out.thin = found.thin;
    out.thinnest = found.thinnest / frame.scale;
    if (out.proof.surfaces_apart || found.points == 0) return;
    // Of independent rays, which these even ones do better than. With one more ray of either kind,
    // so that a share of 0 or 1 is not taken for exact.
    const auto count = static_cast<double>(found.points);
    const double share = (found.open * count + 1.0) / (count + 2.0);
    out.openness_error = std::sqrt(share * (1.0 - share) / count);
}

}  // namespace

SceneAnalysis scene_analysis(const Scene& scene) {
    const auto start = timing::Clock::now();
    validate(scene);
    SceneAnalysis out;
    const std::vector<TriangleAlbedo> albedos = triangle_albedos(scene);
    const LightsFound lights = light_analysis(scene);
    const Bounds box = bounds(scene);
    out.lights = lights.analysis;
    out.motion = motion_analysis(scene);
    out.size = glm::distance(box.low, box.high);

    const std::vector<LocalTriangle> triangles = local_triangles(scene);
    out.surfaces = surface_analysis(scene, triangles, albedos);
    // moving_bounds: a caller says that it will move vertices.
    if (!out.motion.geometry && !scene.moving_bounds) {
        out.proof = prove_openness(scene, triangles, lights.emissive);
        if (out.lights.moving) out.proof.lights_open = false;
    }
    add_surroundings(scene, local_frame(box), triangles, albedos, lights.emissive, out);
    out.milliseconds = timing::milliseconds(timing::Clock::now() - start);
    return out;
}

}  // namespace clgi
