// Settings of each method that are on its front of time against error, and the error that they
// reach on scenes of a kind.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan/plan.hpp>
#include <vector>

namespace clgi {

// What decides how far a method's settings get.
enum class SceneKind {
    convex,     // nothing lies between surfaces, or what does is left out
    furnished,  // large surfaces, things between them
    fine,       // tens of thousands of triangles
    outdoors,   // much light leaves
};
SceneKind kind_of(const Plan& plan);
const char* name_of(SceneKind kind);

struct Rung {
    Method method;
    int directions;  // bins; atlas: texels, side of a page; 0: none
    int places;      // leaves wished, or VPLs
    // By kind: error against all light, measured; 0: was not.
    double error[4];
};

// By method, each from quick to accurate.
const std::vector<Rung>& rungs();

}  // namespace clgi
