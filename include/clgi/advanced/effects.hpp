// The effects that a picture may have, and which of them a scene needs.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/analysis.hpp>
#include <clgi/advanced/export.hpp>
#include <optional>
#include <string>

namespace clgi {

enum class Effect {
    point_light,
    spot_light,
    directional_light,
    area_light,         // of emissive surfaces
    environment_light,  // of the environment, and its picture behind the scene
    direct_shadows,     // of all lights but the environment
    environment_shadows,
    first_bounce,  // indirect light, diffuse
    further_bounces,
    indirect_occlusion,  // what lies between two surfaces
    gloss,               // lobes of materials, of direct and indirect light
    textures,
    cutouts,  // holes of alpha masks, blended surfaces
    moving_geometry,
    moving_lights,
};
constexpr std::size_t effect_count = 15;

// As in the program: "point-light". The other way round: none for an unknown name.
CLGI_API const char* name_of(Effect effect);
CLGI_API std::optional<Effect> effect_of(const std::string& name);

// What a decision is based on.
enum class Evidence {
    absent,     // the scene has nothing of it
    proven,     // a picture without it is the same
    measured,   // a probe estimates what a picture loses without it
    needed,     // nothing bounds what a picture would lose
    requested,  // the caller decided
};
CLGI_API const char* name_of(Evidence evidence);

struct EffectChoice {
    Effect effect = Effect::point_light;
    bool on = false;
    Evidence evidence = Evidence::absent;
    // By how much a picture without it differs: root of the mean squared difference of luminance
    // over the mean luminance. 0 if that is proven, an estimate with a margin if `measured`,
    // infinite if it is not known.
    double bound = 0.0;
    std::string why;  // a sentence
    // What provides it in the method of a plan, such as "shadow maps". "nothing" if it is on and
    // the method does not have it; empty if it is off or no method is chosen yet.
    std::string by;
    double milliseconds = 0.0;  // predicted, that it adds to a picture and what precedes it
    double megabytes = 0.0;     // and to the buffers
};
using EffectChoices = std::array<EffectChoice, effect_count>;  // by Effect

// What small pictures tell in addition to the analysis.
// 0 where no surface reflects light; the first two also without indirect light, and the last one
// where direct light is exact. Infinite where the camera sees none; the first two also where no VPL
// has any.
struct ProbeResult {
    // Root of the mean squared luminance that one bounce, unshadowed, adds to the camera's picture,
    // over the mean luminance of that picture.
    double first_bounce = 0.0;
    // Mean luminance of surfaces by what they reflect of direct light, over all of the scene and
    // over the mean luminance of that picture.
    double reflected = 0.0;
    // What direct light with the defaults of EmitterOptions errs by, about: root of the mean
    // squared difference of luminance over the mean luminance. From pictures with shadow maps of a
    // quarter and of half the pixels along a side, and as many points on emissive surfaces: an
    // error of pixels on edges falls with the square root of these.
    double direct_error = 0.0;
    double milliseconds = 0.0;  // that the pictures took, without building kernels
};

// Decides each effect. It is off if the scene has nothing of it, if a proof says that it changes
// nothing, or if the probe estimates that it changes at most `tolerance`. Without a probe only the
// first two count.
CLGI_API EffectChoices choose_effects(const SceneAnalysis& analysis, double tolerance,
                                      const std::optional<ProbeResult>& probe = std::nullopt);

}  // namespace clgi
