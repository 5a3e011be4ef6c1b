// From the lights of a scene to the emitters that the device samples.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/gbuffer.h>
#include <clgi/shared/lights.h>
#include <clgi/advanced/export.hpp>
#include <clgi/device_scene.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace clgi {

// Of the local frame (DeviceScene::frame()).
struct LocalBox {
    glm::vec3 low, high;
};

struct EmitterOptions {
    int vpls = 300;         // virtual point lights (VPLs), of all emitters together
    int shadow_size = 512;  // pixels per side of a spot or directional light's map
    int face_size = 256;    // pixels per side of a cube or hemicube face
    int area_samples = 16;  // sample points on all emissive surfaces together
    int area_size = 0;      // as face_size, of the maps of sample points; 0: the same
    bool focused = false;   // of surfaces within the scene's focus alone
    // Directional lights that approximate the environment [Debevec05]; in replicates and later
    // samples as many that are drawn from it.
    int environment_lights = 16;
    SkyPart sky_part = SkyPart::whole;  // what they stand for
    int environment_size = 0;           // as shadow_size, of their maps; 0: the same
    // 0: the Halton points themselves. Other values: randomised shifts of them (Cranley and
    // Patterson). The differences between replicates estimate the error of one.
    std::uint32_t replicate = 0;
    // 0: as `replicate` says. Other values: later samples of a picture, with other shifts, a
    // quarter of the points of emissive surfaces, as there are many samples, and shadow maps of all
    // other lights that lie differently within their texels.
    std::uint32_t sample = 0;
    // Shifts VPLs alone: of samples that share the rest.
    std::uint32_t vpl_sample = 0;
    // false: nothing lies between lights and surfaces. Emitters then have no views and no shadow
    // maps, and light every point that faces them. No VPL can be placed without views, so vpls
    // counts as 0.
    bool shadows = true;
    bool directional = true;  // false: the scene's directional lights are left out
    // true: lights are directions of the environment alone, none of the scene's
    bool environment_alone = false;
    // Shadow maps of directional lights cover no more than this, and light all that lies outside;
    // none: they cover the scene. A focus that is much smaller has a map of its own.
    std::optional<LocalBox> receivers;
    // By which directions of the environment are drawn; null: by luminance alone.
    std::shared_ptr<const SkyWeights> sky_weights;
};

// Halton candidates that are tried for a spot at most; a narrower cone is mapped directly.
constexpr std::uint32_t most_candidates = 1u << 22;

// How much buffers must hold for all lights of a scene, also for those that are dark at the moment.
struct EmitterCapacity {
    std::size_t emitters = 0;
    std::size_t views = 0;
    std::size_t pixels = 0;
    // Views of one width are drawn together: with only one of the lights that have such views, the
    // one with the fewest, and with all of them.
    struct Together {
        std::uint32_t width = 0, height = 0;  // pixels, of the largest
        std::uint32_t least = 0, most = 0;    // views
    };
    std::vector<Together> together;
};

struct EmitterSet {
    std::vector<Emitter> emitters;
    std::vector<View> views;                // of all emitters, in order
    std::size_t pixels = 0;                 // of all views
    std::vector<std::uint32_t> candidates;  // Halton candidates to try, by emitter; spots only
    std::size_t vpl_count = 0;
    // Those of the scene's lamps come first, then those that stand for parts of a larger light:
    // directions of the environment, points of surfaces.
    std::size_t lamps = 0, directions = 0;
    bool soft() const { return emitters.size() > lamps; }
    EmitterCapacity capacity;
};

// One emitter for each punctual light, `area_samples` for the emissive triangles (stratified by
// power; in the first sample up to as many more, so that each lamp, triangles with common corners,
// has its power) and `environment_lights` for the environment (median cut [Debevec05]), each with
// its views (without EmitterOptions::shadows: none) and its share of the VPLs: three quarters of
// them by power, a quarter evenly to each lamp, to the emissive triangles and to the environment,
// so that a dim lamp has some beside a bright one that lights nothing. Lights without power are
// left out. Emitters too weak for a VPL of their own leave their indirect light to the others of
// their group (punctual lights, directions, samples). A group without any VPL leaves it to all.
// Power is luminance.
//
// A spot of more than 60 degrees from its axis has the views of a cube, like a point light.
// If more than 2^22 candidates would have to be tried (300 VPLs below a degree), the cone is mapped
// directly instead; its samples then turn with the light.
// Throws Error for options out of range and for more than 2^30 pixels of views.
CLGI_API EmitterSet make_emitters(const DeviceScene& scene, const EmitterOptions& options);

}  // namespace clgi
