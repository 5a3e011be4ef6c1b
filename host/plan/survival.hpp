// How much light goes on.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/plan/facts.hpp>

namespace clgi {

// Of the light that meets surfaces, what they reflect at most. A mean over the scene would not do:
// a picture may show a bright room in a dark landscape.
inline double survival(const SceneFacts& facts) {
    return std::min(facts.surfaces.largest_albedo, 0.99);
}

}  // namespace clgi
