// SPDX-License-Identifier: MIT
#include "scene/local_triangles.hpp"

#include <algorithm>
#include <cmath>

#include "core/on_threads.hpp"

namespace clgi {

std::vector<LocalTriangle> local_triangles(const Scene& scene, const SceneFrame& frame) {
    constexpr std::size_t at_once = 4096;
    std::vector<LocalTriangle> out(scene.triangles.size());
    for_each_of(out.size(), at_once, [&](std::size_t i) {
        const SceneTriangle& triangle = scene.triangles[i];
        LocalTriangle& local = out[i];
        for (std::size_t k = 0; k < 3; ++k)
            local.corners[k] = glm::dvec3(frame.to_local(scene.positions[triangle.vertex[k]]));
        local.double_sided = scene.materials[triangle.material].double_sided;
        const auto& [a, b, c] = local.corners;
        const glm::dvec3 across = glm::cross(b - a, c - a);
        const double twice_area = glm::length(across);
        const auto square = [](const glm::dvec3& side) { return glm::dot(side, side); };
        const double longest = std::sqrt(std::max({square(a - b), square(b - c), square(c - a)}));
        local.area = 0.5 * twice_area;
        local.height = longest > 0.0 ? twice_area / longest : 0.0;
        if (!local.is_line()) local.normal = across / twice_area;
    });
    return out;
}

}  // namespace clgi
