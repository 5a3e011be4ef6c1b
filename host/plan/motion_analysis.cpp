// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/moving_elements.hpp>

#include "plan/parts.hpp"
#include "scene/moving_parts.hpp"

namespace clgi {
namespace {

constexpr std::size_t most_posed = 1u << 22;  // vertices over all times of all clips
constexpr std::size_t fewest_times = 3, most_times = 25;

// What vertices need alone: every pose is a copy.
Scene only_vertices(const Scene& scene) {
    Scene out;
    out.positions = scene.positions;
    out.normals = scene.normals;
    out.triangles = scene.triangles;
    out.parts = scene.parts;
    out.lights = scene.lights;
    out.cameras = scene.cameras;
    out.animation = scene.animation;
    return out;
}

}  // namespace

MotionAnalysis motion_analysis(const Scene& scene) {
    MotionAnalysis out;
    const std::vector<std::uint8_t> moving = moving_vertices(scene);
    if (moving.empty()) return out;
    double moves = 0.0, all = 0.0;
    for (const SceneTriangle& triangle : scene.triangles) {
        const double area = triangle_area(scene, triangle);
        all += area;
        if (!follows(triangle, moving)) continue;
        ++out.moving_triangles;
        moves += area;
        if (scene.materials[triangle.material].emission != glm::vec3(0.0f))
            out.moving_emission = true;
    }
    out.geometry = out.moving_triangles > 0;
    if (!out.geometry) return out;
    if (all > 0.0) out.moving_area = moves / all;
    const Bounds box = bounds(scene);
    const double size = glm::distance(box.low, box.high);
    const Scene posable = only_vertices(scene);
    const std::size_t clips = scene.animation->clips.size();
    const std::size_t times =
        std::clamp(most_posed / (scene.positions.size() * clips), fewest_times, most_times);
    for (std::size_t clip = 0; clip < clips; ++clip)
        for (const std::vector<glm::dvec3>& pose :
             vertex_poses(posable, clip, static_cast<int>(times)))
            for (std::size_t v = 0; v < pose.size(); ++v)
                if (moving[v] != 0)
                    out.travel = std::max(out.travel, glm::distance(pose[v], scene.positions[v]));
    if (size > 0.0) out.travel /= size;
    return out;
}

}  // namespace clgi
