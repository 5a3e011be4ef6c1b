// SPDX-License-Identifier: MIT
#include "plan/method.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <limits>

#include "plan/carrier.hpp"
#include "plan/choice.hpp"
#include "plan/expected_error.hpp"
#include "plan/rungs.hpp"
#include "plan/settings.hpp"

namespace clgi {
namespace {

constexpr double default_seconds = 1.0;        // of a picture
constexpr double default_frame_seconds = 0.1;  // of one of an animation

struct Candidate {
    Plan plan;
    std::optional<double> error;
};

bool fits(const cl::Device& device, const Plan& plan) {
    constexpr double share = 0.8;            // the scene is there as well
    constexpr double most_pixels = 1 << 28;  // emitters take four times as many
    if (shadow_pixels(plan) > most_pixels) return false;
    return plan.cost.megabytes <= 1e-6 * share * device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
}

// Removes those that the device has no room for, unless it has none for any.
void drop_too_large(const cl::Device& device, std::vector<Candidate>& candidates) {
    const auto large = [&](const Candidate& one) { return !fits(device, one.plan); };
    if (std::all_of(candidates.begin(), candidates.end(), large)) return;
    candidates.erase(std::remove_if(candidates.begin(), candidates.end(), large), candidates.end());
}

double unknown_last(const std::optional<double>& error) {
    return error ? *error : std::numeric_limits<double>::max();
}

}  // namespace

void choose_method(const cl::Device& device, Plan& plan) {
    const Choice choice = methods_for(plan);
    std::vector<Candidate> candidates;
    for (const Rung& rung : rungs()) {
        if (std::find(choice.methods.begin(), choice.methods.end(), rung.method) ==
            choice.methods.end())
            continue;
        for (const int fineness : {1, 2, 4, 8, 16}) {
            Candidate one{plan, std::nullopt};
            set(one.plan, rung, fineness);
            one.plan.cost = cost_of(device, one.plan);
            one.error = expected_error(one.plan, rung);
            candidates.push_back(std::move(one));
        }
    }
    drop_too_large(device, candidates);

    const PlanWish& wish = plan.wish;
    const double milliseconds =
        1e3 * wish.seconds.value_or(wish.animated ? default_frame_seconds : default_seconds);
    const auto time = [&](const Candidate& one) {
        return wish.animated ? one.plan.cost.frame_ms : one.plan.cost.total_ms();
    };
    const auto quick = [&](const Candidate& one) { return time(one) <= milliseconds; };
    const auto right = [&](const Candidate& one) { return one.error && *one.error <= *wish.error; };

    // With an error the cheapest that reaches it, within the time if that can be; without one the
    // most accurate within the time. Where nothing reaches that, the nearest.
    const auto better = [&](const Candidate& a, const Candidate& b) {
        const bool hurried = wish.seconds || !wish.error;
        if (hurried && quick(a) != quick(b)) return quick(a);
        if (wish.error && right(a) != right(b)) return right(a);
        if (hurried && !quick(a)) return time(a) < time(b);
        if (wish.error && right(a)) return time(a) < time(b);
        if (!a.error && !b.error) return time(a) > time(b);  // the more work, the better
        return unknown_last(a.error) < unknown_last(b.error);
    };
    const Candidate& best = *std::min_element(candidates.begin(), candidates.end(), better);

    plan = best.plan;
    plan.why = choice.why;
    plan.error = best.error;
    if (best.error) plan.error_ground = ground_of_error(plan);
    plan.meets_time = !wish.seconds || quick(best);
    plan.meets_error = !wish.error || right(best);
    plan.unavoidable = unavoidable(plan, plan.method);
    for (EffectChoice& effect : plan.effects)
        effect.by = effect.on ? carrier_of(plan, plan.method, effect.effect).by : "";
}

}  // namespace clgi
