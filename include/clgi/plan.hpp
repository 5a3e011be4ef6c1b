// A plan: which effects a scene needs, the method that renders them within a time or an error, and
// its settings. Plain data, made before anything runs.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/analysis.hpp>
#include <clgi/advanced/effects.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/reach.hpp>
#include <clgi/renderer.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clgi {

// What is asked for.
struct PlanRequest {
    int width = 640;  // pixels
    int height = 480;
    // Effects are left out if together they are estimated to change a picture by at most this: root
    // of the mean squared difference of luminance over its mean.
    double tolerance = 0.01;
    // The time of a picture with all that is done before it, but without loading, upload and
    // kernels; if animated, the time of a frame. None: 1 s, and 0.1 s for a frame.
    std::optional<double> seconds;
    // Error of the picture against all light, measured as the tolerance. None: any.
    std::optional<double> error;
    // The scene moves from picture to picture, as its animation says: what is prepared must not
    // depend on where things are.
    bool animated = false;
    bool lights_change = false;  // set_light() will be called: nothing is proven of lights, and
                                 // dark ones count as lights
    // Many samples follow the picture (Renderer::refine), which take most of the error of direct
    // light away: settings are chosen for the rest.
    bool refined = false;
    bool camera_moves = false;          // no probe: it would hold for one picture alone
    std::vector<Effect> with, without;  // overrule what is decided; no effect is in both
    std::optional<Method> method;       // overrules the choice
    // Of EmitterOptions, for direct light. None: the plan chooses.
    std::optional<int> shadow_size, face_size, area_samples;
    BuildOptions build;
};

// Predictions. Times are rough: constants of one machine, scaled by clock, units and lanes.
struct PlanCost {
    double once_ms = 0.0;   // before the first picture of a process whose kernels are built
    double frame_ms = 0.0;  // each picture under the same lights
    double megabytes = 0.0;
    double total_ms() const { return once_ms + frame_ms; }
};

// What is known of a picture that was rendered by a plan.
struct PlanOutcome {
    std::optional<double> error;    // that a check measured
    std::optional<double> took_ms;  // with all before it
    std::optional<double> doubt;    // IrradianceCache::doubt()
};

struct PlanCheck {
    Method method = Method::direct;
    std::optional<double> expected;  // error, by the kind of scene alone
    std::optional<double> indirect;  // Plan::indirect_error
    double predicted_ms = 0.0;       // of all that the plan does, by the machine's class alone
    PlanOutcome found;
};

// The options of a Renderer, and the reasons for them.
struct Plan : RendererOptions {
    Plan() { method = Method::direct; }

    PlanRequest request;
    // Of the scene without the lights and the gloss that the request leaves out.
    SceneAnalysis analysis;
    std::optional<ProbeResult> probe;
    std::optional<Reach> reach;     // of the camera; none without one
    std::vector<PlanCheck> checks;  // of the plans before this one
    EffectChoices effects;
    // What all effects that are left out for the tolerance change: 0 where that is proven,
    // otherwise an estimate by the probe with a margin.
    double bound = 0.0;

    std::string why;  // a sentence: the method
    // Effects that are off by request, but that the method cannot leave out.
    std::vector<Effect> unavoidable;
    PlanCost cost;
    // The error against all light that these settings had in measured scenes of this kind, and in
    // which; after pictures, as many times as much as checks and doubt say. None if nothing was
    // measured, the probe saw no light, or the request leaves out an effect that the scene needs.
    std::optional<double> error;
    std::string error_evidence;
    // What indirect light is expected to err by, relative to itself, by the kind of scene alone;
    // none where the error is that of the sky's light, too.
    std::optional<double> indirect_error;
    // As predicted. True if nothing was requested; meets_error is false if the error is unknown.
    bool meets_time = true, meets_error = true;

    bool on(Effect effect) const { return effects[static_cast<std::size_t>(effect)].on; }
};

// From the analysis alone. Throws Error for a request that is out of range or contradicts itself.
CLGI_API Plan make_plan(const cl::Device& device, const SceneAnalysis& analysis,
                        const PlanRequest& request);

// Analyses the scene and what the camera reaches of it. If that leaves open whether indirect light
// matters, uploads the scene and draws a few small pictures of it.
CLGI_API Plan make_plan(const cl::CommandQueue& queue, const Programs& programs, const Scene& scene,
                        const Camera& camera, const PlanRequest& request);

// The method of a plan with settings for so many seconds, or with its quickest: how long that
// picture takes tells next_plan what to expect of this machine.
CLGI_API Plan trial_plan(const cl::Device& device, const Plan& plan, double seconds);

// The plan to go on with after a picture by `plan`. Settings of a method are expected to err by as
// many times more as a check measured, or of indirect light by as many times as its doubt says, and
// to take as many times as long as pictures of the plan and of those before it did; if another
// method was quicker than predicted, that says nothing of a method. What was tried, and what is
// coarser, is not tried again. None if nothing is expected to err less than what was measured, or
// else expected of `plan`, within the seconds that are left; without them, those that were
// requested. Where no error is expected, finer settings of the same method follow. Throws Error for
// an error, a time or a doubt that is negative or not a number.
CLGI_API std::optional<Plan> next_plan(const cl::Device& device, const Plan& plan,
                                       const PlanOutcome& found,
                                       std::optional<double> seconds = std::nullopt);

// The error to expect of a picture by a plan now that it is made: what a check measured; else
// Plan::error, with indirect light by the doubt of the picture where that says more than scenes of
// the kind and nothing was measured before, and direct light as plan.request.refined says now.
// Throws Error for an outcome that is negative or not a number.
CLGI_API std::optional<double> error_of(const Plan& plan, const PlanOutcome& found);

// Whether the picture reaches so little of the scene that methods that share their work out over
// all of it, and a probe by them, tell little of the picture.
CLGI_API bool sees_little(const Plan& plan);

// What a picture of width x height pixels reaches, where that is little of the scene: its focus
// (Scene::focus). Throws InputError for a broken scene.
CLGI_API std::optional<Focus> focus_of(const Scene& scene, const Camera& camera, int width,
                                       int height);

// The scene without the lights, emission, environment, gloss, textures, alpha and animation
// whose effects are off. A texture of one colour is replaced by this colour. Textures that are no
// longer read are dropped, and the others are renumbered. Where the picture sees little of the
// scene, the focus is what it reaches.
CLGI_API Scene planned_scene(const Scene& scene, const Plan& plan);

}  // namespace clgi
