// All that the host lays out for a light atlas of a scene in which things move: the atlas is of
// what stands still, and an irradiance volume lights what moves through it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/bake_layout.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/irradiance_volume.hpp>
#include <clgi/advanced/static_scene.hpp>

namespace clgi {

constexpr int most_volume_points = 512;

// For a LightAtlasSolver of `still` with `layout` and points_of(volume), and a LightAtlasView of
// the whole scene with `whole` and `volume`.
//
// Light counts once: direct light, with the shadows of all that moves, is the view's; indirect
// light of what stands still is the atlas's, of what moves the volume's. What moves casts no
// indirect shadow, and reflects and emits nothing onto the rest; where it hides itself its indirect
// light is too much. So what closes an opening, such as a door, leaves the indirect light behind it
// as it was baked: the error there is up to all of that light.
struct StaticBake {
    StaticScene static_scene;
    BakeLayout layout;  // of still.scene
    AtlasLayout whole;
    IrradianceVolume volume;
};

// volume: of Scene::moving_bounds, else of the motion_bounds of all clips. Throws what
// make_bake_layout and make_irradiance_volume throw, and InputError for a scene of which nothing
// stands still or nothing moves.
CLGI_API StaticBake make_static_bake(const Scene& scene, const VplOptions& vpls = {},
                                     const AtlasOptions& atlas = {},
                                     int most_points = most_volume_points);

}  // namespace clgi
