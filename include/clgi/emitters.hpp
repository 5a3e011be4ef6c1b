// From a scene's lights to the sources that the device samples.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/gbuffer.h>
#include <clgi/shared/lights.h>
#include <clgi/device_scene.hpp>
#include <clgi/export.hpp>
#include <vector>

namespace clgi {

struct EmitterOptions {
    int lights = 300;       // indirect lights, shared by power
    int shadow_size = 512;  // pixels, side of a spot's or directional light's image
    int face_size = 256;    // pixels, side of a cube or hemicube face
    int area_samples = 16;  // points that stand for all emissive surfaces together
    int environment_lights = 16;  // directions that stand for the environment
    // 0: the Halton points themselves; any other: a randomised shift of them (Cranley and
    // Patterson), so that several replicates tell how far off one is.
    std::uint32_t replicate = 0;
};

struct EmitterSet {
    std::vector<Emitter> emitters;
    std::vector<View> views;                // of all emitters, in order
    std::size_t pixels = 0;                 // of all views
    std::vector<std::uint32_t> candidates;  // Halton candidates to try, by emitter; spots only
    std::size_t light_count = 0;
};

// One emitter a lamp, `area_samples` more for the emissive triangles (stratified by power) and
// `environment_lights` for the environment (median cut [Debevec05]), each with its views and its
// share of the indirect lights. Lamps without power are left out. Sources too weak for an indirect
// light of their own leave their indirect light to the others: lamps to lamps, directions to
// directions, samples to samples; a group without any light to all. Power is by luminance.
//
// A spot of more than 60 degrees from its axis is seen through a cube, like a point light.
// Where more than 2^22 candidates would have to be tried (300 lights below a degree), the cone is
// mapped directly instead: its samples then turn with the light.
// Throws Error for options out of range and for more than 2^30 pixels of views.
CLGI_API EmitterSet make_emitters(const DeviceScene& scene, const EmitterOptions& options);

}  // namespace clgi
