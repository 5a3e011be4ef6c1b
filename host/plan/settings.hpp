// From effects and a preset to the settings of a plan.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>

#include "plan/presets.hpp"

namespace clgi {

// The plan's method and all settings. fineness: 1, or how many times as fine direct light is as
// EmitterOptions has it, where the request does not say: pixels of shadow maps along a side, and
// points on emissive surfaces. Below 1: maps of few suns and spots have that part of their side, and
// all else is as with 1.
void set(Plan& plan, const Preset& preset, double fineness);

// Whether points on emissive surfaces are not enough, as each stands for more than a small part of
// what the picture reaches. Hemicubes see such lamps (IrradianceCacheOptions::emission).
bool points_are_large(const Plan& plan);

// How fine direct light is for the lights that the plan has: the least of what set() makes finer.
double fineness_of(const Plan& plan);

// The plan with one effect less: its settings as they are, without what that effect alone needs.
Plan without_effect(const Plan& plan, Effect effect);

}  // namespace clgi
