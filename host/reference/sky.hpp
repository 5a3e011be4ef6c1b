// The environment as the path tracer has it: looked up, and drawn from in proportion to what it
// sends.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "reference/random.hpp"

namespace clgi::reference {

// A texel is drawn with the probability of its share in the luminance of all, solid angle included,
// and a direction evenly in it: density is luminance over the luminance's integral, exactly.
class Sky {
public:
    explicit Sky(const std::optional<Environment>& environment);

    bool shines() const { return shines_; }
    // The same in every direction: directions drawn for a surface's sake serve as well as any.
    bool even() const { return width_ == 1 && height_ == 1; }

    // direction: unit, from the surface to the sky. cd/m^2
    glm::vec3 radiance(const glm::vec3& direction) const;
    // Of sample() at a direction, per steradian.
    float density(const glm::vec3& direction) const;
    glm::vec3 sample(Random& random) const;

private:
    const glm::vec3& texel(const glm::vec3& direction) const;

    bool shines_ = false;
    int width_ = 1;
    int height_ = 1;
    double turn_ = 0.0;              // of the picture against the world, in turns
    std::vector<glm::vec3> values_;  // [height][width] cd/m^2
    std::vector<double> rows_;       // [height] sums of luminance times solid angle up to a row
    std::vector<double> columns_;    // [height][width] and within it
};

}  // namespace clgi::reference
