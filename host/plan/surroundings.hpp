// What surfaces have around them, by rays on the host: how much of what they send leaves the scene,
// which of them lights meet, and how thick they are.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

#include "plan/local_triangles.hpp"

namespace clgi {

// Shares are of points. Lengths in local units.
struct Surroundings {
    std::size_t points = 0;
    double open = 0.0;       // cosine-weighted directions in which nothing is seen
    double backs = 0.0;      // that end on the back of a single-sided triangle
    double lit = 0.0;        // points that a light meets
    double lit_twice = 0.0;  // of these, those that more than one meets
    double thin = 0.0;      // of those on single-sided triangles, those on walls thinner than asked
    double thinnest = 0.0;  // least thickness of a wall; 0: there is none
};

struct SurroundingsOptions {
    double thin = 0.0;  // local units
    bool open = true;   // false: nothing is before any surface, so directions are not looked in
};

// Points spread evenly over the sides of triangles with a weight above 0; none if there are none.
// Looks in 64 to 1024 directions, in as many as make some 5e6 tests of a ray and a triangle; into
// walls from 64 to 256 points, and from as many to lights: 1 to 16 of them each, fewer where there
// are many triangles, one of each of so many equal parts of the list. emissive: triangles; they are
// one light, to a point of which each point looks. Light that comes in at a cosine of less than
// 1e-3 does not count. frame: in which the triangles are local.
Surroundings survey(const std::vector<Light>& lights, const SceneFrame& frame,
                    const std::vector<LocalTriangle>& triangles, const std::vector<double>& weights,
                    const std::vector<std::uint32_t>& emissive, const SurroundingsOptions& options);

}  // namespace clgi
