// Vertices that are equal in everything become one.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>

namespace clgi {

// To the bit; the first of them stays. Vertices of no triangle are dropped.
void merge_equal_vertices(Scene& scene);

}  // namespace clgi
