// Settings of each method that are on its front of time against error, and the error that they
// reach on scenes of a kind.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/plan.hpp>
#include <vector>

namespace clgi {

// What decides how far a method's settings get.
enum class SceneKind {
    convex,     // nothing lies between surfaces, or what does is left out
    furnished,  // large surfaces, things between them
    fine,       // more than ten thousand triangles
    open,       // much light leaves
    indirect,   // most of what the camera sees is lit by other surfaces
    skylit,     // the sky lights it, by hemicubes
    fine_sky,   // the same of more than ten thousand triangles
};
// Root mean square of indirect light over the mean of the picture, by the probe; 1 without one.
double indirect_share(const Plan& plan);
bool is_fine(const Plan& plan);  // of more than ten thousand triangles
SceneKind kind_of(const Plan& plan);
const char* name_of(SceneKind kind);

struct Preset {
    Method method;
    int directions;  // bins; atlas: texels, side of a page; 0: none
    int places;      // leaves requested, or VPLs
    // By kind: error of indirect light, over its share (expected_error.hpp); of transfer and of
    // scenes with a sky, of the whole picture, of fine ones after four samples. Measured; 0: was
    // not.
    double error[7];
};

// By method, each from quick to accurate.
const std::vector<Preset>& presets();

}  // namespace clgi
