// The analysis that decisions are based on, with the request applied.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>

namespace clgi {

// Without the lights and the gloss that the request leaves out, so that they decide nothing else.
// If lights will change, dark lights count as lights, and nothing is proven about any light.
SceneAnalysis requested_analysis(SceneAnalysis analysis, const PlanRequest& request);

}  // namespace clgi
