// Which method brings the effects of a plan, with which settings, at what cost.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan/plan.hpp>

namespace clgi {

// Sets the method, its settings, cost and error.
void choose_method(const cl::Device& device, Plan& plan);

// The plan with one effect less: its settings as they are, without what that effect alone needs.
Plan without_effect(const Plan& plan, Effect effect);

// Of the plan's method with its settings and effects.
PlanCost cost_of(const cl::Device& device, const Plan& plan);

}  // namespace clgi
