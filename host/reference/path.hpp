// The light that leaves a surface towards whoever looks at it, by one random path.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>

#include "reference/bsdf.hpp"
#include "reference/guide.hpp"
#include "reference/lights.hpp"
#include "reference/sky.hpp"
#include "reference/tracer.hpp"

namespace clgi::reference {

class Paths {
public:
    Paths(const Geometry& geometry, const Tracer& tracer, const Lights& lights, const Sky& sky,
          const Options& options)
        : geometry_(geometry),
          tracer_(tracer),
          lights_(lights),
          sky_(sky),
          effects_(options.effects),
          sampling_(options.sampling),
          // Lobes alone find an even sky without noise of its own.
          sky_sampling_(sky.even() && sampling_ == Sampling::both ? Sampling::lobes : sampling_),
          roulette_depth_(options.roulette_depth) {}

    // Half of the directions are drawn by a guide from here on, which must live as long; null: none
    // are.
    void follow(const Guide* guide) { guide_ = guide; }

    // direction: in which `seen` was looked at, unit. An unbiased sample of radiance, cd/m^2. What
    // a path meets is added to `met`, if it is given.
    glm::vec3 sample(const Surface& seen, const glm::vec3& direction, Random& random,
                     std::vector<Met>* met = nullptr) const;

    // The same of a direction in which nothing is.
    glm::vec3 background(const glm::vec3& direction) const {
        return effects_.emission ? sky_.radiance(direction) : glm::vec3(0.0f);
    }

private:
    // How directions are drawn at a surface: by what it reflects, or as often by what was learnt.
    struct Scatter {
        glm::vec3 sample(Random& random) const;
        float density(const glm::vec3& direction) const;

        const Bsdf& bsdf;
        bool glossy;
        const Guide::Cell* learnt;
    };

    bool counts(int bounces) const;
    bool glossy(int bounces) const;
    glm::vec3 walk(Surface surface, glm::vec3 direction, int last, Random& random,
                   std::vector<Met>* met) const;
    glm::vec3 unshadowed(const Surface& surface, const glm::vec3& direction, Random& random) const;
    glm::vec3 lit(const Surface& surface, const Bsdf& bsdf, bool glossy, const Scatter* also,
                  Random& random) const;
    glm::vec3 sent_on(const std::optional<Arrival>& light, float share, const Surface& surface,
                      const Bsdf& bsdf, bool glossy, Random& random) const;
    std::optional<Arrival> from_sky(const glm::vec3& point, Random& random) const;

    const Geometry& geometry_;
    const Tracer& tracer_;
    const Lights& lights_;
    const Sky& sky_;
    Effects effects_;
    Sampling sampling_;
    Sampling sky_sampling_;
    int roulette_depth_;
    const Guide* guide_ = nullptr;
};

}  // namespace clgi::reference
