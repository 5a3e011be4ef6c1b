// What a bake costs, predicted from its settings.
// SPDX-License-Identifier: MIT
#pragma once

namespace clgi::light_atlas {

struct BakeCost {
    double ms = 0.0;  // on a device of fitted_pairs (core/kit/ranges.hpp)
    double bytes = 0.0;
};

// Layout, transport and filling; without occlusion nothing is drawn. A fit of times on two cores of
// a CPU with packets of 16 (docs/plan.md).
BakeCost bake_cost(double vpls, double texels, double triangles, bool occlusion);

}  // namespace clgi::light_atlas
