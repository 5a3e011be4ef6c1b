// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/advanced/still_bake.hpp>
#include <optional>

#include "scene/local_frame.hpp"

namespace clgi {
namespace {

Bounds box_of_motion(const Scene& scene) {
    if (scene.moving_bounds) return *scene.moving_bounds;
    std::optional<Bounds> out;
    for (std::size_t clip = 0; clip < scene.animation->clips.size(); ++clip)
        if (const std::optional<Bounds> box = motion_bounds(scene, clip)) out = united(*box, out);
    if (!out) throw InputError("still-bake: what moves has no place");
    return *out;
}

}  // namespace

StillBake make_still_bake(const Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas,
                          int most_points) {
    StillBake out;
    out.still = still_scene(scene);
    if (out.still.triangles.empty())
        throw InputError("still-bake: nothing of the scene stands still");
    if (out.still.triangles.size() == scene.triangles.size())
        throw InputError("still-bake: nothing of the scene moves");
    out.layout = make_bake_layout(out.still.scene, vpls, atlas);
    out.whole = atlas_of_whole(out.layout.atlas, out.still.triangles, scene.triangles.size());
    out.volume = make_irradiance_volume(box_of_motion(scene), most_points);
    return out;
}

}  // namespace clgi
