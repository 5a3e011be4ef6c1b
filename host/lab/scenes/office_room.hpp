// The office, for scenes that put something into it.
// SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenes/interiors.hpp"

namespace clgi::generated {

// Into a scene that is empty. The floor is y = 0; a circle of 1.35 m around (3.15, 2.35) is free.
void add_office(Scene& scene, const OfficeOptions& options);

}  // namespace clgi::generated
