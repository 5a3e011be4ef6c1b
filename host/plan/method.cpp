// SPDX-License-Identifier: MIT
#include "plan/method.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <iterator>
#include <limits>

#include "plan/choice.hpp"
#include "plan/expected_error.hpp"
#include "plan/presets.hpp"
#include "plan/provider.hpp"
#include "plan/settings.hpp"
#include "plan/static_part.hpp"

namespace clgi {
namespace {

constexpr double default_seconds = 1.0;        // of a picture
constexpr double default_frame_seconds = 0.1;  // of one of an animation
constexpr double patience = 10.0;     // seconds, for an error that nothing reaches, or before an
                                      // animation begins
constexpr double near_enough = 1.05;  // errors that are as good as the least
constexpr double coarse_pays = 0.85;  // of a picture's time, with coarser maps

struct Candidate {
    Plan plan;
    std::optional<double> error;
    double of_kind = 0.0;  // the preset's
};

bool fits(const cl::Device& device, const Plan& plan) {
    constexpr double share = 0.8;            // the scene is there as well
    constexpr double most_pixels = 1 << 28;  // emitters take four times as many
    if (shadow_pixels(plan) > most_pixels) return false;
    const auto largest = static_cast<double>(device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>());
    if (plan.method == Method::irradiance_cache && plan.cache.transport_bytes() > share * largest)
        return false;
    return plan.cost.megabytes <= 1e-6 * share * device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
}

// Removes what was checked, and what is as coarse or coarser.
void drop_checked(std::vector<Candidate>& candidates) {
    constexpr double finer = 1.2;  // takes so many times as long, at least
    const auto checked = [](const Candidate& one) {
        const auto& checks = one.plan.checks;
        return std::any_of(checks.begin(), checks.end(), [&](const PlanCheck& check) {
            return check.method == one.plan.method &&
                   one.plan.cost.total_ms() < finer * pace_of(one.plan) * check.predicted_ms;
        });
    };
    candidates.erase(std::remove_if(candidates.begin(), candidates.end(), checked),
                     candidates.end());
}

// Whether the time is better spent on samples than on large shadow maps, which they share.
bool may_be_coarse(const PlanRequest& request) { return request.refined && request.seconds; }

// Records that were not measured in scenes of the kind.
bool is_not_measured(const Candidate& one) {
    return one.plan.method == Method::irradiance_cache && !(one.of_kind > 0.0);
}

// Removes those that the device has no room for, unless it has none for any.
void drop_too_large(const cl::Device& device, std::vector<Candidate>& candidates) {
    const auto large = [&](const Candidate& one) { return !fits(device, one.plan); };
    if (std::all_of(candidates.begin(), candidates.end(), large)) return;
    candidates.erase(std::remove_if(candidates.begin(), candidates.end(), large), candidates.end());
}

// Removes those that nobody waits for before the first picture, unless there are no others.
void drop_too_slow_to_begin(std::vector<Candidate>& candidates) {
    const auto slow = [](const Candidate& one) { return one.plan.cost.once_ms > 1e3 * patience; };
    if (std::all_of(candidates.begin(), candidates.end(), slow)) return;
    candidates.erase(std::remove_if(candidates.begin(), candidates.end(), slow), candidates.end());
}

}  // namespace

double error_factor(const Plan& plan) {
    double factor = 1.0;
    for (const PlanCheck& check : plan.checks)
        if (check.method == plan.method && check.found.error && check.expected &&
            *check.expected > 0.0)
            factor = std::max(factor, *check.found.error / *check.expected);
    return factor;
}

double pace_of(const Plan& plan) {
    double own = 0.0, others = 1.0;
    for (const PlanCheck& check : plan.checks) {
        if (!check.found.took_ms || !(check.predicted_ms > 0.0)) continue;
        const double pace = *check.found.took_ms / check.predicted_ms;
        if (check.method == plan.method) own = pace;
        others = std::max(others, pace);
    }
    return own > 0.0 ? own : others;
}

PlanCost paced_cost(const cl::Device& device, const Plan& plan) {
    const double pace = pace_of(plan);
    PlanCost out = cost_of(device, plan);
    out.once_ms *= pace;
    out.frame_ms *= pace;
    return out;
}

bool choose_method(const cl::Device& device, Plan& plan) {
    const Choice choice = methods_for(plan);
    const EffectChoices effects = plan.effects;
    for (EffectChoice& effect : plan.effects) effect.why.clear();  // candidates are many copies
    std::vector<Candidate> candidates;
    for (const Preset& preset : presets()) {
        if (std::find(choice.methods.begin(), choice.methods.end(), preset.method) ==
            choice.methods.end())
            continue;
        double usual_ms = 0.0;
        for (const double fineness : {1.0, 0.5, 2.0, 4.0, 8.0, 16.0}) {
            if (fineness < 1.0 && !may_be_coarse(plan.request)) continue;
            Candidate one{plan, std::nullopt};
            set(one.plan, preset, fineness);
            one.of_kind = preset.error[static_cast<std::size_t>(kind_of(one.plan))];
            if (is_not_measured(one)) continue;
            one.plan.cost = paced_cost(device, one.plan);
            if (fineness == 1.0) usual_ms = one.plan.cost.total_ms();
            if (fineness < 1.0 && one.plan.cost.total_ms() > coarse_pays * usual_ms) continue;
            one.error = expected_error(one.plan, one.of_kind);
            if (one.error) *one.error *= error_factor(one.plan);
            candidates.push_back(std::move(one));
        }
    }
    drop_checked(candidates);
    if (candidates.empty()) return false;
    drop_too_large(device, candidates);
    if (plan.request.animated) drop_too_slow_to_begin(candidates);

    const PlanRequest& request = plan.request;
    const double milliseconds =
        1e3 * request.seconds.value_or(request.animated ? default_frame_seconds : default_seconds);
    const auto time = [&](const Candidate& one) {
        return request.animated ? one.plan.cost.frame_ms : one.plan.cost.total_ms();
    };
    const auto quick = [&](const Candidate& one) { return time(one) <= milliseconds; };
    const auto right = [&](const Candidate& one) {
        return one.error && *one.error <= *request.error;
    };

    const auto quicker = [&](const Candidate& a, const Candidate& b) { return time(a) < time(b); };
    // Keeps the candidates that are wanted, if there are any, and says whether.
    const auto keep = [&](const auto& wanted) {
        std::vector<Candidate> out;
        std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(out), wanted);
        if (!out.empty()) candidates = std::move(out);
        return !candidates.empty() && wanted(candidates.front());
    };
    // With an error the cheapest that reaches it, within the time if that can be; without one the
    // most accurate within the time. Where nothing reaches either, the nearest.
    const auto choose = [&] {
        const auto cheapest = [&] {
            return *std::min_element(candidates.begin(), candidates.end(), quicker);
        };
        if ((request.seconds || !request.error) && !keep(quick)) return cheapest();
        if (request.error && keep(right)) return cheapest();
        keep([&](const Candidate& one) { return time(one) <= 1e3 * patience; });
        const auto known = [](const Candidate& one) { return one.error.has_value(); };
        if (!keep(known))  // the more work, the better
            return *std::max_element(candidates.begin(), candidates.end(), quicker);
        double least = std::numeric_limits<double>::max();
        for (const Candidate& one : candidates) least = std::min(least, *one.error);
        keep([&](const Candidate& one) { return *one.error <= near_enough * least; });
        return cheapest();
    };
    const Candidate best = choose();

    plan = best.plan;
    plan.effects = effects;
    plan.why = !request.method && is_composed(plan) ? "little moves through light that is baked"
                                                    : choice.why;
    if (!left_out_by_request(plan)) plan.error = best.error;
    plan.indirect_error.reset();
    if (plan.error && best.of_kind > 0.0 && !gathers_the_sky(plan))
        plan.indirect_error = best.of_kind;
    if (plan.error) plan.error_evidence = evidence_of_error(plan);
    plan.meets_time = !request.seconds || quick(best);
    plan.meets_error = !request.error || (plan.error && right(best));
    plan.unavoidable = unavoidable(plan, plan.method);
    for (EffectChoice& effect : plan.effects)
        effect.by = effect.on ? provider_of(plan, plan.method, effect.effect).by : "";
    return true;
}

}  // namespace clgi
