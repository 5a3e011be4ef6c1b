// SPDX-License-Identifier: MIT
#include "plan/parts.hpp"
#include "scene/moving_parts.hpp"

namespace clgi {

MotionAnalysis motion_analysis(const Scene& scene) {
    MotionAnalysis out;
    const std::vector<std::uint8_t> moving = moving_vertices(scene);
    if (moving.empty()) return out;
    double moves = 0.0, all = 0.0;
    for (const SceneTriangle& triangle : scene.triangles) {
        const double area = triangle_area(scene, triangle);
        all += area;
        if (!follows(triangle, moving)) continue;
        out.geometry = true;
        moves += area;
        if (scene.materials[triangle.material].emission != glm::vec3(0.0f))
            out.moving_emission = true;
    }
    if (all > 0.0) out.moving_area = moves / all;
    return out;
}

}  // namespace clgi
