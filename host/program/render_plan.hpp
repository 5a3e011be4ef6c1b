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

// Plans by the flags, says so, and leaves of the scene what the plan renders.
std::shared_ptr<const Planned> make_render_plan(const RenderFlags& flags, const Session& session,
                                                const Programs& programs, Scene& scene);

}  // namespace clgi::program
