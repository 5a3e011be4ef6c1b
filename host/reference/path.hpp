// The light that leaves a surface towards whoever looks at it, by one random path.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>

#include "reference/bsdf.hpp"
#include "reference/lights.hpp"
#include "reference/tracer.hpp"

namespace clgi::reference {

class Paths {
public:
    Paths(const Geometry& geometry, const Tracer& tracer, const Lights& lights,
          const Effects& effects, int roulette_depth)
        : geometry_(geometry),
          tracer_(tracer),
          lights_(lights),
          effects_(effects),
          roulette_depth_(roulette_depth) {}

    // direction: in which `seen` was looked at, unit. An unbiased sample of radiance, cd/m^2.
    glm::vec3 sample(const Surface& seen, const glm::vec3& direction, Random& random) const;

private:
    bool counts(int bounces) const;
    bool glossy(int bounces) const;
    glm::vec3 walk(Surface surface, glm::vec3 direction, int last, Random& random) const;
    glm::vec3 unshadowed(const Surface& surface, const glm::vec3& direction, Random& random) const;
    glm::vec3 lit(const Surface& surface, const Bsdf& bsdf, bool glossy, bool also_met,
                  Random& random) const;
    glm::vec3 by_lamp(std::size_t lamp, const Surface& surface, const Bsdf& bsdf,
                      bool glossy) const;

    const Geometry& geometry_;
    const Tracer& tracer_;
    const Lights& lights_;
    Effects effects_;
    int roulette_depth_;
};

}  // namespace clgi::reference
