// SPDX-License-Identifier: MIT
#include <clgi/still_scene.hpp>

#include "scene/local_frame.hpp"
#include "scene/moving_parts.hpp"

namespace clgi {

StillScene still_scene(const Scene& scene) {
    StillScene out;
    out.scene = scene;
    out.scene.animation.reset();
    out.scene.parts.clear();
    out.scene.triangles.clear();
    const std::vector<std::uint8_t> moving = moving_vertices(scene);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        if (follows(scene.triangles[t], moving)) continue;
        out.scene.triangles.push_back(scene.triangles[t]);
        out.triangles.push_back(t);
    }
    if (scene.triangles.empty()) return out;
    // The frame of the whole scene.
    out.scene.moving_bounds = united(bounds(scene), scene.moving_bounds);
    return out;
}

}  // namespace clgi
