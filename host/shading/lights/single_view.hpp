// Which lights have one shadow map of shadow_size; others have the faces of a cube or a hemicube.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>

namespace clgi {

constexpr float widest_single_view = 1.0472f;  // 60 degrees

inline bool has_single_view(const Light& light) {
    return light.kind == Light::Kind::directional ||
           (light.kind == Light::Kind::spot && light.outer_angle <= widest_single_view);
}

}  // namespace clgi
