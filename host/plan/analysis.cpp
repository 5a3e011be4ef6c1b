// SPDX-License-Identifier: MIT
#include <clgi/advanced/analysis.hpp>

#include "core/opencl/timing.hpp"
#include "plan/local_scene.hpp"
#include "plan/openness.hpp"
#include "plan/proof.hpp"

namespace clgi {

SceneAnalysis scene_analysis(const Scene& scene, const LocalScene& local) {
    const auto start = timing::Clock::now();
    SceneAnalysis out;
    const SurfacesFound surfaces = surface_analysis(scene, local.triangles);
    out.surfaces = surfaces.analysis;
    out.lights = local.lights.analysis;
    out.motion = motion_analysis(scene);
    // moving_bounds: a caller says that it will move vertices.
    if (!out.motion.geometry && !scene.moving_bounds) {
        out.proof = prove_openness(scene, local.triangles, local.lights.emissive);
        if (out.lights.moving) out.proof.lights_open = false;
    }
    std::vector<double> asked{much_open};
    if (out.lights.environment) asked.push_back(mostly_open);
    out.openness = out.proof.surfaces_apart
                       ? 1.0
                       : openness(local.triangles, local.blockers, surfaces.reflects, asked);
    out.milliseconds = local.milliseconds + timing::milliseconds(timing::Clock::now() - start);
    return out;
}

SceneAnalysis scene_analysis(const Scene& scene) {
    return scene_analysis(scene, LocalScene(scene));
}

}  // namespace clgi
