// A plan: which effects a scene calls for, the method that brings them within a time or an error,
// and its settings. Plain data, made before anything runs.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/analysis.hpp>
#include <clgi/advanced/effects.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/renderer.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clgi {

// What is asked for.
struct PlanRequest {
    int width = 640;  // pixels
    int height = 480;
    // Effects may be left out that change a picture by at most this together: root of the mean
    // squared difference of luminance over its mean.
    double tolerance = 0.01;
    // A picture may take so long, with all that is done before it but loading, upload and kernels.
    // None: what the method takes by default.
    std::optional<double> seconds;
    // Of the picture, against all light, as tolerance is measured. None: none in particular.
    std::optional<double> error;
    // The scene moves from picture to picture, as its animation says: what is done before may not
    // depend on where things are.
    bool animated = false;
    bool lights_change = false;  // set_light() will be called: nothing is proven of lights, and
                                 // dark ones count as lights
    bool camera_moves = false;   // no probe: it would hold for one picture alone
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

// The options of a Renderer, and why they are so.
struct Plan : RendererOptions {
    Plan() { method = Method::direct; }

    PlanRequest request;
    SceneAnalysis
        analysis;  // of the scene without the lights and the gloss that the request leaves out
    std::optional<ProbeResult> probe;
    EffectChoices effects;
    double bound = 0.0;  // what all effects that are left out for the tolerance change at most

    std::string why;  // a sentence: the method
    // Off by request, but the method cannot do without: they are rendered all the same.
    std::vector<Effect> unavoidable;
    PlanCost cost;
    // Error against all light that the method reaches with such settings on scenes of this kind, as
    // measured, and where; none where nothing was measured, the probe saw no light, or the request
    // leaves out what the scene calls for.
    std::optional<double> error;
    std::string error_evidence;
    // As predicted; true where nothing was asked for, meets_error false where the error is unknown.
    bool meets_time = true, meets_error = true;

    bool on(Effect effect) const { return effects[static_cast<std::size_t>(effect)].on; }
};

// From analysis alone. Throws Error for a request out of range or one that excludes itself.
CLGI_API Plan make_plan(const cl::Device& device, const SceneAnalysis& analysis,
                        const PlanRequest& request);

// Reads the analysis and, where they leave open whether indirect light matters, uploads the scene
// and draws two small pictures of it.
CLGI_API Plan make_plan(const cl::CommandQueue& queue, const Programs& programs, const Scene& scene,
                        const Camera& camera, const PlanRequest& request);

// The scene with what the plan renders alone: without lights, emission, environment, gloss,
// textures, alpha masks and animation whose effects are off. What is off because it changes nothing
// (a texture of one colour, a mask without holes) is replaced by what it comes to. Textures that
// are not read any more are dropped, the others renumbered.
CLGI_API Scene planned_scene(const Scene& scene, const Plan& plan);

}  // namespace clgi
