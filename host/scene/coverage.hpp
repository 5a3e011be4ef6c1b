// How much of what lies behind a surface hides, by its alpha.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/scene.hpp>

namespace clgi {

// In [0,1]; not a number counts as 0 where alpha matters.
inline double covered(const Material& material, double alpha) {
    switch (material.alpha_mode) {
        case AlphaMode::mask:
            return alpha >= double{material.alpha_cutoff} ? 1.0 : 0.0;
        case AlphaMode::blend:
            return alpha > 0.0 ? std::min(alpha, 1.0) : 0.0;
        case AlphaMode::opaque:
            break;
    }
    return 1.0;
}

}  // namespace clgi
