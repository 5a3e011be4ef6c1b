// From the analysis and a request to a plan: effects, then the method and its settings, then the
// cost of each effect.
// SPDX-License-Identifier: MIT
#include <clgi/plan.hpp>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>

#include "plan/expected_error.hpp"
#include "plan/method.hpp"
#include "plan/probe.hpp"
#include "plan/reach.hpp"
#include "plan/requested_analysis.hpp"
#include "plan/settings.hpp"

namespace clgi {
namespace {

void need(bool right, const std::string& what) {
    if (!right) throw Error("plan: " + what);
}

bool asked(const std::vector<Effect>& list, Effect effect) {
    return std::find(list.begin(), list.end(), effect) != list.end();
}

void check(const PlanRequest& request) {
    need(request.width >= 1 && request.width <= 16384 && request.height >= 1 &&
             request.height <= 16384,
         "width and height are " + std::to_string(request.width) + " and " +
             std::to_string(request.height) + ", 1 to 16384 needed");
    need(request.tolerance >= 0.0 && std::isfinite(request.tolerance),
         "tolerance is negative or not finite");
    need(!request.seconds || (*request.seconds > 0.0 && std::isfinite(*request.seconds)),
         "seconds is not above 0 or not finite");
    need(!request.error || (*request.error > 0.0 && std::isfinite(*request.error)),
         "error is not above 0 or not finite");
    for (const Effect effect : {Effect::further_bounces, Effect::indirect_occlusion})
        need(!asked(request.with, effect) || !asked(request.without, Effect::first_bounce),
             std::string(name_of(effect)) + " is with, but its first-bounce is without");
    for (const Effect effect : request.with)
        need(std::find(request.without.begin(), request.without.end(), effect) ==
                 request.without.end(),
             std::string(name_of(effect)) + " is both with and without");
}

void check(const PlanOutcome& found) {
    for (const std::optional<double>& value : {found.error, found.took_ms, found.doubt})
        need(!value || (*value >= 0.0 && std::isfinite(*value)),
             "the measured error, the time or the doubt is negative or not a number");
}

PlanCheck check_of(const Plan& plan, const PlanOutcome& found) {
    std::optional<double> expected = plan.error;
    if (expected) *expected /= error_factor(plan);
    if (doubt_factor(plan) > 1.0) {
        Plan by_kind = plan;
        by_kind.checks.clear();
        expected = expected_error(by_kind, plan.indirect_error.value_or(0.0));
    }
    return {plan.method, expected, plan.indirect_error, plan.cost.total_ms() / pace_of(plan),
            found};
}

// called: what the whole scene needs.
void overrule(EffectChoices& effects, const EffectChoices& called, const SceneAnalysis& analysis,
              const PlanRequest& request) {
    const auto set = [&](Effect effect, bool on) {
        EffectChoice& choice = effects[static_cast<std::size_t>(effect)];
        if (choice.on == on) return;
        choice.on = on;
        choice.evidence = Evidence::requested;
        choice.why =
            std::string(on ? "asked for; without: " : "left out by request; ") + choice.why;
    };
    for (const Effect effect : request.without) {
        // The analysis no longer has what is left out, so it would count as absent.
        EffectChoice& choice = effects[static_cast<std::size_t>(effect)];
        if (!choice.on) choice = called[static_cast<std::size_t>(effect)];
        set(effect, false);
    }
    for (const Effect effect : request.with) set(effect, true);
    // The other parts of indirect light need its first bounce, which is on if they are requested.
    const Effect rest[] = {Effect::further_bounces, Effect::indirect_occlusion};
    for (const Effect effect : rest)
        if (asked(request.with, effect)) set(Effect::first_bounce, true);
    const EffectChoice& first = effects[static_cast<std::size_t>(Effect::first_bounce)];
    if (first.evidence != Evidence::requested) return;
    for (const Effect effect : rest) {
        const bool nothing = effect == Effect::indirect_occlusion && analysis.proof.surfaces_open;
        if (!first.on || (!asked(request.without, effect) && !nothing)) set(effect, first.on);
    }
}

// What is left out for the tolerance: indirect light, and its further bounces, which are a part of
// it.
double largest_bound(const EffectChoices& effects) {
    double out = 0.0;
    for (const EffectChoice& choice : effects)
        if (!choice.on && choice.evidence == Evidence::measured) out = std::max(out, choice.bound);
    return out;
}

// What each effect that is on adds: the plan's cost less that of the plan without it.
void price(const cl::Device& device, Plan& plan) {
    for (EffectChoice& choice : plan.effects) {
        if (!choice.on) continue;
        const PlanCost less = paced_cost(device, without_effect(plan, choice.effect));
        choice.milliseconds = std::max(0.0, plan.cost.total_ms() - less.total_ms());
        choice.megabytes = std::max(0.0, plan.cost.megabytes - less.megabytes);
    }
}

// Effects alone.
Plan decided(const SceneAnalysis& analysis, const PlanRequest& request,
             const std::optional<Reach>& reach, const std::optional<ProbeResult>& probed) {
    Plan plan;
    plan.request = request;
    plan.reach = reach;
    plan.analysis = requested_analysis(analysis, request);
    plan.probe = probed;
    plan.effects = choose_effects(plan.analysis, request.tolerance, probed);
    overrule(plan.effects, choose_effects(analysis, request.tolerance, probed), plan.analysis,
             request);
    plan.bound = largest_bound(plan.effects);
    return plan;
}

// And the method, with its settings and cost.
Plan completed(const cl::Device& device, Plan plan) {
    choose_method(device, plan);
    price(device, plan);
    return plan;
}

}  // namespace

Plan make_plan(const cl::Device& device, const SceneAnalysis& analysis,
               const PlanRequest& request) {
    check(request);
    return completed(device, decided(analysis, request, std::nullopt, std::nullopt));
}

Plan make_plan(const cl::CommandQueue& queue, const Programs& programs, const Scene& scene,
               const Camera& camera, const PlanRequest& request) {
    check(request);
    const auto device = queue.getInfo<CL_QUEUE_DEVICE>();
    const LocalScene local(scene);
    const SceneAnalysis analysis = scene_analysis(scene, local);
    const bool one_picture = !request.animated && !request.lights_change && !request.camera_moves;
    std::optional<Reach> reach;
    if (one_picture) reach = reach_of(scene, local, camera, request.width, request.height);
    const Plan unprobed = decided(analysis, request, reach, std::nullopt);
    const bool open = unprobed.on(Effect::first_bounce) || unprobed.on(Effect::direct_shadows);
    const auto with = [&](const ProbeResult& probed) {
        return completed(device, decided(analysis, request, reach, probed));
    };
    if (!one_picture || !open) return completed(device, unprobed);
    // What reflects nothing looks the same however it is lit.
    if (!(unprobed.analysis.surfaces.largest_albedo > 0.0)) return with(ProbeResult{});
    if (sees_little(unprobed)) return completed(device, unprobed);
    const DeviceScene uploaded(queue.getInfo<CL_QUEUE_CONTEXT>(), device,
                               planned_scene(scene, unprobed));
    return with(probe(queue, programs, uploaded, camera, unprobed));
}

Plan trial_plan(const cl::Device& device, const Plan& plan, double seconds) {
    need(seconds > 0.0 && std::isfinite(seconds), "the seconds of a trial are not above 0");
    Plan out = plan;
    out.request.method = plan.method;
    out.request.seconds = seconds;
    choose_method(device, out);
    price(device, out);
    out.request = plan.request;
    out.why = plan.why;
    out.meets_time = plan.meets_time;
    return out;
}

std::optional<double> error_of(const Plan& plan, const PlanOutcome& found) {
    check(found);
    if (found.error) return found.error;
    if (!plan.error || !plan.indirect_error) return plan.error;
    Plan made = plan;
    if (found.doubt) made.checks.push_back(check_of(plan, found));
    return expected_error(made, *plan.indirect_error).value_or(*plan.error) * error_factor(plan);
}

std::optional<Plan> next_plan(const cl::Device& device, const Plan& plan, const PlanOutcome& found,
                              std::optional<double> seconds) {
    constexpr double less = 0.95;        // of the error; otherwise it does not pay
    constexpr double surely_less = 0.7;  // what is asked for
    constexpr double patience = 1e4;     // ms, where no time was requested
    check(found);
    need(!seconds || (*seconds >= 0.0 && std::isfinite(*seconds)),
         "the time that is left is negative or not a number");
    Plan out = plan;
    if (seconds) out.request.seconds = seconds;
    out.checks.push_back(check_of(plan, found));
    if (out.request.error && found.error)
        out.request.error = std::min(*out.request.error, surely_less * *found.error);
    if (!choose_method(device, out)) return std::nullopt;
    price(device, out);
    const double most = out.request.seconds ? 1e3 * *out.request.seconds : patience;
    const std::optional<double> error = error_of(plan, found);
    if (out.cost.total_ms() > most) return std::nullopt;
    // Where errors are not known, finer settings of the same method are taken to err less.
    const bool better =
        out.error && error ? *out.error <= less * *error : found.error || out.method == plan.method;
    if (!better) return std::nullopt;
    out.request.seconds = plan.request.seconds;
    out.request.error = plan.request.error;
    out.meets_error = !out.request.error || (out.error && *out.error <= *out.request.error);
    return out;
}

}  // namespace clgi
