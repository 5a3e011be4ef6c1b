// What a point in space sees of the surfaces around it: whether it lies in solid matter, and how
// far they are in every direction.
//
//   mean(d) = (1/n) sum_i r_i,   square(d) = (1/n) sum_i r_i^2      [Majercik19]
//
// over n rays through the texel of d in an octahedral map.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/volume.h>

#include "methods/light_atlas/walls.hpp"

namespace clgi {

class Surroundings {
public:
    // The scene must outlive this object.
    explicit Surroundings(const Scene& scene);

    // Moves a point that lies in solid matter out of it, by at most `reach` metres; whether it lies
    // in the open then. Solid matter is where at least half of what directions meet are backs of
    // surfaces that are not double-sided.
    bool in_the_open(glm::dvec3& point, double reach) const;

    // VOLUME_TEXELS values; unit: metres, of what is stored.
    void distances(const glm::dvec3& point, double unit, glm::vec2* out) const;

private:
    struct Backs {
        bool solid = false;
        glm::dvec3 nearest = glm::dvec3(0.0);  // metres from the point
    };
    Backs backs_around(const glm::dvec3& point) const;
    Walls::Met ray(const glm::dvec3& point, const glm::dvec3& way) const;

    const Scene& scene_;
    Walls walls_;
    glm::dvec3 middle_ = glm::dvec3(0.0);  // of the scene, metres
    double radius_ = 0.0;                  // metres
};

}  // namespace clgi
