// Points on the edges along which an atlas cuts a smooth surface, seen from both sides.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "methods/light_atlas/lookup.hpp"

namespace clgi {

struct SeamPoint {
    AtlasTaps side[2];
    double length;  // m of the edge that it stands for
};

// A texel apart or closer, in the order of the scene's edges. Points without a listed texel on both
// sides are left out.
std::vector<SeamPoint> seam_points(const Scene& scene, const AtlasLayout& atlas);

}  // namespace clgi
