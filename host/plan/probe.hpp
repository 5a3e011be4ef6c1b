// Two small pictures that tell what indirect light is worth.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/plan/effects.hpp>
#include <clgi/plan/plan.hpp>
#include <clgi/programs.hpp>

namespace clgi {

// Whether indirect light may be little enough to be left out, and pictures tell it: they have no
// indirect gloss.
bool worth_probing(const SceneFacts& facts);

// One picture with direct light alone, and one with a bounce that nothing shadows. scene: the
// planned_scene() of the plan so far.
ProbeFacts probe(const cl::CommandQueue& queue, const Programs& programs, const DeviceScene& scene,
                 const Camera& camera, const Plan& plan);

}  // namespace clgi
