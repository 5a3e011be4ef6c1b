// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/static_scene.hpp>

#include "scene/local_frame.hpp"
#include "scene/moving_parts.hpp"

namespace clgi {

bool moves(const Scene& scene) {
    const std::vector<std::uint8_t> moving = moving_vertices(scene);
    return std::any_of(scene.triangles.begin(), scene.triangles.end(),
                       [&](const SceneTriangle& triangle) { return follows(triangle, moving); });
}

StaticScene static_scene(const Scene& scene) {
    StaticScene out;
    out.scene = scene;
    out.scene.animation.reset();
    out.scene.parts.clear();
    out.scene.triangles.clear();
    const std::vector<std::uint8_t> moving = moving_vertices(scene);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        if (follows(scene.triangles[t], moving)) {
            const Material& material = scene.materials[scene.triangles[t].material];
            out.moving_emission |= material.emission != glm::vec3(0.0f);
            continue;
        }
        out.scene.triangles.push_back(scene.triangles[t]);
        out.triangles.push_back(t);
    }
    if (scene.triangles.empty()) return out;
    // The frame of the whole scene.
    out.scene.moving_bounds = united(bounds(scene), scene.moving_bounds);
    return out;
}

}  // namespace clgi
