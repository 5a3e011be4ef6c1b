// How much light goes on.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/advanced/analysis.hpp>

namespace clgi {

// Of the light that meets surfaces, what they reflect at most. A mean over the scene would not do:
// a picture may show a bright room in a dark landscape.
inline double survival(const SceneAnalysis& analysis) {
    return std::min(analysis.surfaces.largest_albedo, 0.99);
}

// Whether a probe bounds indirect light: there may be little of it, and there is no gloss, which
// the pictures of a probe do not have.
inline bool bounds_indirect_light(const SceneAnalysis& analysis) {
    constexpr double little = 0.3;  // survives a bounce
    return survival(analysis) < little && !(analysis.surfaces.glossy_area > 0.0);
}

}  // namespace clgi
