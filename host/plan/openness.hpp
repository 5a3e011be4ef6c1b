// How much of what surfaces send leaves the scene, by rays on the host.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "scene/local_triangles.hpp"
#include "scene/rays.hpp"

namespace clgi {

// Decisions ask whether more than these shares of directions are open: much light leaves, and the
// sky lights most of the scene.
constexpr double much_open = 0.3, mostly_open = 0.5;

// Share of cosine-weighted directions in which nothing is seen, from points spread evenly over the
// sides of triangles with a weight above 0; 0 if there are none. By 64 to 1024 rays, as many as
// make some 5e6 tests of a ray and a triangle; 128 are enough where the share is far from those
// that are asked for.
double openness(const std::vector<LocalTriangle>& triangles, const Blockers& blockers,
                const std::vector<double>& weights, const std::vector<double>& asked);

}  // namespace clgi
