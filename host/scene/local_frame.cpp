// SPDX-License-Identifier: MIT
#include "scene/local_frame.hpp"

#include <algorithm>
#include <cmath>

#include "scene/environment.hpp"

namespace clgi {

Bounds united(const Bounds& box, const std::optional<Bounds>& other) {
    if (!other) return box;
    return {glm::min(box.low, other->low), glm::max(box.high, other->high)};
}

SceneFrame local_frame(const Bounds& box, const std::optional<Focus>& focus) {
    SceneFrame frame;
    frame.origin = 0.5 * (box.low + box.high);
    double radius = 0.5 * glm::length(box.high - box.low), detail = radius;
    if (focus && focus->radius < radius) {
        radius += glm::distance(focus->centre, frame.origin);
        frame.origin = focus->centre;
        detail = focus->radius;
    }
    if (detail > 0.0) {
        int exponent = 0;
        std::frexp(detail, &exponent);
        frame.scale = std::ldexp(1.0, -exponent);
    }
    frame.radius = static_cast<float>(std::max(radius * frame.scale, 1e-6));
    frame.detail = static_cast<float>(std::max(detail * frame.scale, 1e-6));
    frame.low = frame.to_local(box.low);
    frame.high = frame.to_local(box.high);
    return frame;
}

Bounds reached(const SceneFrame& frame) {
    const glm::dvec3 around(1e-5 * double{frame.radius});
    return {glm::dvec3(frame.low) - around, glm::dvec3(frame.high) + around};
}

double common_exposure(const Scene& scene, const SceneFrame& frame) {
    double brightest = 0.0;
    for (const Light& light : scene.lights) {
        const double strongest =
            std::max({light.intensity.x, light.intensity.y, light.intensity.z});
        const bool directional = light.kind == Light::Kind::directional;
        brightest =
            std::max(brightest, strongest * (directional ? 1.0 : frame.scale * frame.scale));
    }
    for (const Material& material : scene.materials)
        brightest = std::max({brightest, double{material.emission.x}, double{material.emission.y},
                              double{material.emission.z}});
    if (scene.environment) {
        const glm::dvec3 fluence = environment_fluence(*scene.environment);
        brightest = std::max({brightest, fluence.x, fluence.y, fluence.z});
    }
    if (!(brightest > 0.0)) return 1.0;
    int exponent = 0;
    std::frexp(brightest, &exponent);
    return std::ldexp(1.0, exponent);
}

}  // namespace clgi
