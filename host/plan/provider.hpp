// Which part of a method provides an effect.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>

namespace clgi {

struct Provider {
    const char* by;       // "nothing": the method cannot
    bool always = false;  // also where the effect is off
};
// Given what else is on in the plan.
Provider provider_of(const Plan& plan, Method method, Effect effect);

// Effects that are off by request, but that the method cannot leave out.
std::vector<Effect> unavoidable(const Plan& plan, Method method);

}  // namespace clgi
