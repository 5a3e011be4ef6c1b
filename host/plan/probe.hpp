// Small pictures that tell what indirect light is worth.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/effects.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/plan.hpp>
#include <clgi/programs.hpp>

namespace clgi {

// A picture with a bounce that nothing shadows and one with direct light alone, if indirect light
// is on; and one with finer direct light, if that is not exact. scene: the planned_scene() of the
// plan so far.
ProbeResult probe(const cl::CommandQueue& queue, const Programs& programs, const DeviceScene& scene,
                  const Camera& camera, const Plan& plan);

}  // namespace clgi
