// Which method renders the effects of a plan, with which settings, at what cost.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>

namespace clgi {

// Sets the method, its settings, cost and error. False if all settings were checked.
bool choose_method(const cl::Device& device, Plan& plan);

// Of the plan's method with its settings and effects.
PlanCost cost_of(const cl::Device& device, const Plan& plan);

// How many times as large as expected errors of the plan's method were, by checks; at least 1.
double error_factor(const Plan& plan);

// How many times as long as predicted for its class of machines pictures took here: the last of the
// plan's method, or else the slowest of others, and no less than 1.
double pace_of(const Plan& plan);

// cost_of at that pace.
PlanCost paced_cost(const cl::Device& device, const Plan& plan);

// Of all shadow maps of direct light in the picture, predicted.
double shadow_pixels(const Plan& plan);

}  // namespace clgi
