// What the parts of a plan read of a scene, made once.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/analysis.hpp>
#include <clgi/device_scene.hpp>

#include "core/opencl/timing.hpp"
#include "plan/parts.hpp"
#include "scene/rays.hpp"

namespace clgi {

struct LocalScene {
    // Throws InputError for a broken scene, as validate() does.
    explicit LocalScene(const Scene& scene);
    LocalScene(const LocalScene&) = delete;
    LocalScene& operator=(const LocalScene&) = delete;

    SceneFrame frame;  // of a scene that stands still
    std::vector<LocalTriangle> triangles;
    Blockers blockers;
    LightsFound lights;
    double milliseconds;  // that this took

private:
    LocalScene(const Scene& scene, timing::Clock::time_point start);
};

SceneAnalysis scene_analysis(const Scene& scene, const LocalScene& local);

}  // namespace clgi
