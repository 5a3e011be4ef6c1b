// The facts that decide, once a wish has been heard.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>

namespace clgi {

// Without the lights and the gloss that the wish leaves out, so that nothing else is decided by
// them. Where lights will change, dark ones count as lights, and nothing is proven of any.
SceneFacts wished_facts(SceneFacts facts, const PlanWish& wish);

}  // namespace clgi
