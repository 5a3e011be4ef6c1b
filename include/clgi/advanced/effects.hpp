// The effects that a picture may have, and which of them a scene calls for.
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
    cutouts,  // holes of alpha masks
    moving_geometry,
    moving_lights,
};
constexpr std::size_t effect_count = 15;

// As in the program: "point-light". The other way round: none for an unknown name.
CLGI_API const char* name_of(Effect effect);
CLGI_API std::optional<Effect> effect_of(const std::string& name);

// What a decision stands on.
enum class Evidence {
    absent,     // the scene has nothing of it
    proven,     // a picture without it is the same
    measured,   // a probe bounds what a picture loses without it
    needed,     // nothing bounds what a picture would lose
    requested,  // the caller decided
};
CLGI_API const char* name_of(Evidence evidence);

struct EffectChoice {
    Effect effect = Effect::point_light;
    bool on = false;
    Evidence evidence = Evidence::absent;
    // What a picture without it differs by at most: root of the mean squared difference of
    // luminance over the mean luminance. Infinite where nothing bounds it.
    double bound = 0.0;
    std::string why;  // a sentence
    // What brings it with the method of a plan, such as "shadow maps"; "nothing" where it is on and
    // the method cannot, empty where it is off or no method is chosen yet.
    std::string by;
    double milliseconds = 0.0;  // that it adds to a picture and what is done before, predicted
    double megabytes = 0.0;     // and to the buffers
};
using EffectChoices = std::array<EffectChoice, effect_count>;  // by Effect

// What small pictures tell beyond the analysis.
// 0 where no surface reflects light. Infinite where the camera sees none; the first two also where
// no VPL has any.
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

// Decides each effect: off where the scene has nothing of it, where the proofs say that it changes
// nothing, or where the probe bounds what it changes by `tolerance`. Without a probe only the first
// two.
CLGI_API EffectChoices choose_effects(const SceneAnalysis& analysis, double tolerance,
                                      const std::optional<ProbeResult>& probe = std::nullopt);

}  // namespace clgi
