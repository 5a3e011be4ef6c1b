// A light atlas in a plan for pictures between which things move.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>

namespace clgi {

// Whether an atlas holds the static part alone, and an irradiance volume lights what moves.
inline bool bakes_static_part(const Plan& plan) {
    return plan.request.animated && plan.on(Effect::moving_geometry) &&
           plan.analysis.motion.geometry;
}

// Whether the plan renders by such an atlas.
inline bool is_composed(const Plan& plan) {
    return plan.method == Method::light_atlas && bakes_static_part(plan);
}

}  // namespace clgi
