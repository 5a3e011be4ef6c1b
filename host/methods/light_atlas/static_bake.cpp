// SPDX-License-Identifier: MIT
#include <clgi/advanced/static_bake.hpp>
#include <clgi/error.hpp>
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

StaticBake make_static_bake(const Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas,
                            int most_points) {
    StaticBake out;
    out.static_scene = static_scene(scene);
    if (out.static_scene.triangles.empty())
        throw InputError("still-bake: nothing of the scene stands still");
    if (out.static_scene.triangles.size() == scene.triangles.size())
        throw InputError("still-bake: nothing of the scene moves");
    out.layout = make_bake_layout(out.static_scene.scene, vpls, atlas);
    out.whole =
        atlas_of_whole(out.layout.atlas, out.static_scene.triangles, scene.triangles.size());
    out.volume = make_irradiance_volume(box_of_motion(scene), most_points, out.static_scene.scene);
    return out;
}

}  // namespace clgi
