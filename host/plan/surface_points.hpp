// Points spread evenly over surfaces.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "scene/local_triangles.hpp"

namespace clgi {

struct SurfacePoint {
    glm::dvec3 position;  // local
    glm::dvec3 normal;    // unit, of the side that it is on
    std::uint32_t triangle;
};

// One in each of `count` equal parts of the sides of triangles with a weight above 0, the front and
// the back of double-sided ones, so that all large triangles have their share. None if there are no
// such triangles. The same scene has the same points.
std::vector<SurfacePoint> surface_points(const std::vector<LocalTriangle>& triangles,
                                         const std::vector<double>& weights, std::size_t count);

}  // namespace clgi
