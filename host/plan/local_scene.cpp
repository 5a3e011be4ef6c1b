// SPDX-License-Identifier: MIT
#include "plan/local_scene.hpp"

#include "scene/local_frame.hpp"

namespace clgi {
namespace {

using timing::Clock;

Bounds checked_bounds(const Scene& scene) {
    validate(scene);
    return bounds(scene);
}

}  // namespace

LocalScene::LocalScene(const Scene& scene) : LocalScene(scene, Clock::now()) {}

LocalScene::LocalScene(const Scene& scene, Clock::time_point start)
    : frame(local_frame(checked_bounds(scene))),
      triangles(local_triangles(scene, frame)),
      blockers(triangles),
      lights(light_analysis(scene)),
      milliseconds(timing::milliseconds(Clock::now() - start)) {}

}  // namespace clgi
