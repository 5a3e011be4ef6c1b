// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/still_bake.hpp>
#include <limits>

#include "scene/moving_parts.hpp"

namespace clgi {
namespace {

Bounds box_of_moving(const Scene& scene) {
    if (scene.moving_bounds) return *scene.moving_bounds;
    const std::vector<std::uint8_t> moving = moving_vertices(scene);
    Bounds out{glm::dvec3(std::numeric_limits<double>::max()),
               glm::dvec3(std::numeric_limits<double>::lowest())};
    for (std::size_t v = 0; v < moving.size(); ++v) {
        if (moving[v] == 0) continue;
        out.low = glm::min(out.low, scene.positions[v]);
        out.high = glm::max(out.high, scene.positions[v]);
    }
    return moving.empty() ? bounds(scene) : out;
}

}  // namespace

StillBake make_still_bake(const Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas,
                          int most_points) {
    StillBake out;
    out.still = still_scene(scene);
    if (out.still.triangles.empty())
        throw InputError("still-bake: nothing of the scene stands still");
    out.layout = make_bake_layout(out.still.scene, vpls, atlas);
    out.whole = atlas_of_whole(out.layout.atlas, out.still.triangles, scene.triangles.size());
    out.volume = make_irradiance_volume(box_of_moving(scene), most_points);
    return out;
}

}  // namespace clgi
