// Small pictures by plans, and how far they are apart.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>
#include <clgi/renderer.hpp>
#include <cmath>

#include "frames.hpp"

namespace clgi::test {

constexpr int plan_width = 32, plan_height = 24;

using Radiances = std::vector<glm::vec3>;

inline double luminance_of(const glm::vec3& rgb) {
    return glm::dot(glm::dvec3(rgb), glm::dvec3(0.2126, 0.7152, 0.0722));
}

inline double mean(const Radiances& picture) {
    double sum = 0.0;
    for (const glm::vec3& pixel : picture) sum += luminance_of(pixel);
    return sum / static_cast<double>(picture.size());
}

// Root of the mean squared difference of luminance, cd/m^2.
inline double distance(const Radiances& a, const Radiances& b) {
    double squares = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k)
        squares += std::pow(luminance_of(a[k]) - luminance_of(b[k]), 2);
    return std::sqrt(squares / static_cast<double>(a.size()));
}

inline PlanRequest quick(std::vector<Effect> with = {}, std::vector<Effect> without = {}) {
    PlanRequest out;
    out.width = plan_width;
    out.height = plan_height;
    out.seconds = 0.2;
    out.with = std::move(with);
    out.without = std::move(without);
    return out;
}

inline std::vector<Effect> all_effects() {
    std::vector<Effect> out;
    for (std::size_t k = 0; k < effect_count; ++k) out.push_back(static_cast<Effect>(k));
    return out;
}

inline Plan plan_of(const Scene& scene, const Camera& camera, const PlanRequest& request) {
    return make_plan(device().queue, programs(), scene, camera, request);
}

// The path tracer's, of `samples` a pixel.
inline Radiances traced(const Scene& scene, const Camera& camera, int samples,
                        const reference::Effects& effects = {}) {
    reference::Options tracing;
    tracing.width = plan_width;
    tracing.height = plan_height;
    tracing.samples = samples;
    tracing.effects = effects;
    return reference::PathTracer(scene).render(camera, tracing).radiance;
}

inline Radiances shown_by(const Renderer& renderer) {
    return vectors(device().queue, renderer.radiance(), renderer.stride(),
                   std::size_t{plan_width} * plan_height);
}

}  // namespace clgi::test
