// The environment in a plan.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>

namespace clgi {

// Whether the plan renders the light of an environment. The effect alone may be on by request in a
// scene that has none.
inline bool has_sky(const Plan& plan) {
    return plan.on(Effect::environment_light) && plan.analysis.lights.environment;
}

// Methods whose sky is a few directional lights, with shadow maps as others have.
inline bool has_sky_lights(Method method) {
    return method == Method::direct || method == Method::second_order ||
           method == Method::light_atlas;
}

}  // namespace clgi
