// How much of what surfaces send leaves a scene, by rays on the host.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "plan/local_triangles.hpp"

namespace clgi {

struct Openness {
    double open = 1.0, open_error = 0.0;  // share of rays that meet nothing, its standard error
    double backs = 0.0;                   // share that end on the back of a single-sided triangle
};

// Cosine-weighted rays from points spread evenly over the sides of triangles with a weight above 0:
// the front, and the back of double-sided ones. If there are none, from all. Compares some 5e6
// pairs of a ray and a triangle, by 64 to 1024 rays. The same scene gives the same rays.
Openness estimate_openness(const std::vector<LocalTriangle>& triangles,
                           const std::vector<double>& weights);

}  // namespace clgi
