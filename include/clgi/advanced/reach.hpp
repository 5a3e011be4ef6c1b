// How much of a scene a picture sees, at first and at second hand.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstddef>

namespace clgi {

// Estimated by few paths from the camera backwards: a seldom seen part may be missed.
struct Reach {
    std::size_t points = 0;  // places that paths met; 0: nothing is known, and the rest is 1
    // Around nine tenths of them.
    Focus sphere;
    double area = 1.0;   // share of the scene's, of what the sphere, half as large again, holds
    double power = 1.0;  // share of the power of lamps (lumen, without directional lights and the
                         // environment) that it holds, or that some of the places see
    double emissive_area = 0.0;  // m^2, of what it holds
    // Share of the power of these emissive surfaces that none of the places sees.
    double hidden = 0.0;
    // Radius of the sphere over that of the scene.
    double size = 1.0;
    // Metres that the cone of a spot covers, across, at the distance of the sphere's centre: that of
    // the widest.
    double cone = 0.0;
    // Metres that a pixel covers, across, of what is seen at first hand: a quarter covers less.
    double pixel = 0.0;
    // Share of cosine-weighted directions in which nothing is seen, from what is seen at first and
    // at second hand; by 64 to 512 rays, fewer from what leaves no second hand. Unlike
    // SceneAnalysis::openness it knows nothing of the outer sides of walls; [0,1].
    double open = 0.0;
    // Root of the mean square, over what is seen at first hand, of the share of gloss in what
    // materials reflect of even light, without their textures; [0,1].
    double gloss = 0.0;
    double milliseconds = 0.0;
};

}  // namespace clgi
