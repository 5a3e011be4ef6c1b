// The analysis that decide, once a request has been heard.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>

namespace clgi {

// Without the lights and the gloss that the request leaves out, so that nothing else is decided by
// them. Where lights will change, dark ones count as lights, and nothing is proven of any.
SceneAnalysis requested_analysis(SceneAnalysis analysis, const PlanRequest& request);

}  // namespace clgi
