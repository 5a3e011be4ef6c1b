// Where pictures are seen from, as kernels have it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/gbuffer.h>
#include <glm/glm.hpp>

namespace clgi {

// xyz: local frame; w 1: the direction to the eye, everywhere.
inline glm::vec4 eye_of(const View& view) {
    return view.eye.w == 0.0f ? view.eye : glm::vec4(-glm::vec3(view.forward), 1.0f);
}

}  // namespace clgi
