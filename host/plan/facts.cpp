// SPDX-License-Identifier: MIT
#include <clgi/plan/facts.hpp>

#include <algorithm>
#include <chrono>

#include "plan/local_triangles.hpp"
#include "plan/openness.hpp"
#include "plan/parts.hpp"
#include "plan/proof.hpp"

namespace clgi {

SceneFacts scene_facts(const Scene& scene) {
    const auto start = std::chrono::steady_clock::now();
    validate(scene);
    SceneFacts out;
    const std::vector<TriangleAlbedo> albedos = triangle_albedos(scene);
    const LightsFound lights = light_facts(scene);
    const Bounds box = bounds(scene);
    out.lights = lights.facts;
    out.motion = motion_facts(scene);
    out.size = glm::distance(box.low, box.high);

    const std::vector<LocalTriangle> triangles = local_triangles(scene);
    out.surfaces = surface_facts(scene, triangles, albedos);
    // moving_bounds: a caller says that it will move vertices.
    if (!out.motion.geometry && !scene.moving_bounds) {
        out.proof = prove_openness(scene, triangles, lights.emissive);
        if (out.lights.moving) out.proof.lights_open = false;
    }
    if (out.proof.surfaces_apart) {
        out.openness = 1.0;
    } else {
        std::vector<double> reflects;
        for (const TriangleAlbedo& albedo : albedos)
            reflects.push_back(std::max({albedo.all.x, albedo.all.y, albedo.all.z}));
        const Openness estimate = estimate_openness(triangles, reflects);
        out.openness = estimate.open;
        out.openness_error = estimate.open_error;
        out.backs = estimate.backs;
    }
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    out.milliseconds = taken.count();
    return out;
}

}  // namespace clgi
