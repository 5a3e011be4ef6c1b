// clgi render --method auto: the plan of the scene, and what is left of the scene by it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>
#include <memory>

#include "program/render_flags.hpp"

namespace clgi::program {

struct Planned {
    Plan plan;
    double milliseconds = 0.0;  // that analysis, reach and probe took
};

// What the flags ask of a plan. Throws Error for invalid ones.
PlanRequest plan_request(const RenderFlags& flags);

// Plans by the flags, says so and renders what the plan leaves of the scene. With --target-error
// the picture is checked, and others are made by other settings until the check's upper bound is
// within the error or nothing better is known; the best is kept.
void render_planned(const RenderFlags& flags, const Session& session, const Programs& programs,
                    const Scene& scene);

}  // namespace clgi::program
