// SPDX-License-Identifier: MIT
#include "plan/method.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <limits>

#include "plan/carrier.hpp"
#include "plan/choice.hpp"
#include "plan/rungs.hpp"

namespace clgi {
namespace {

constexpr double default_seconds = 1.0;        // of a picture
constexpr double default_frame_seconds = 0.1;  // of one of an animation
struct Named {
    Method method;
    const char* name;
};
constexpr Named names[] = {{Method::direct, "direct"},
                           {Method::second_order, "second-order"},
                           {Method::light_atlas, "atlas"},
                           {Method::antiradiance, "antiradiance"},
                           {Method::dynamic_transfer, "transfer"}};

// Brings the settings to the effects: what is off is switched off.
void apply_effects(Plan& plan) {
    const BuildOptions& build = plan.wish.build;
    // The sky of these methods is a few directional lights, with shadow maps as others have.
    const bool sky = plan.method == Method::direct || plan.method == Method::second_order ||
                     plan.method == Method::light_atlas;
    const bool shadows =
        plan.on(Effect::direct_shadows) ||
        (sky && plan.on(Effect::environment_light) && plan.on(Effect::environment_shadows));
    const auto emitters = [&](EmitterOptions& options) { options.shadows = shadows; };

    emitters(plan.picture.emitters);
    plan.picture.build = build;

    SecondOrderOptions& second = plan.second_order;
    second.indirect = plan.method != Method::direct && plan.on(Effect::first_bounce);
    if (!plan.on(Effect::indirect_occlusion)) second.negative_vpls = 0;
    // VPLs are placed through the views of lights.
    second.emitters.shadows = shadows || second.indirect;
    second.build = build;

    emitters(plan.light_atlas.emitters);
    // All bounces cost little more than one where the transport is kept.
    plan.light_atlas.bounces = plan.on(Effect::further_bounces) ? 0 : 1;
    plan.light_atlas.build = build;

    emitters(plan.antiradiance.emitters);
    if (!plan.on(Effect::gloss)) plan.antiradiance.least_gloss = 1.0;
    const EffectChoice& occlusion =
        plan.effects[static_cast<std::size_t>(Effect::indirect_occlusion)];
    plan.antiradiance.occlusion = occlusion.on && occlusion.ground == Ground::wished
                                      ? Occlusion::always
                                      : Occlusion::automatic;
    plan.antiradiance.build = build;

    DynamicTransferOptions& transfer = plan.transfer;
    transfer.shadowed = plan.on(Effect::environment_shadows);
    transfer.gloss = plan.on(Effect::gloss);
    transfer.bounces = plan.on(Effect::first_bounce) && transfer.shadowed ? 1 : 0;
    transfer.build = build;
    plan.transfer_view.picture = plan.picture;
}

// Those of the methods that draw direct light in the picture.
template <typename Change>
void change_emitters(Plan& plan, const Change& change) {
    for (EmitterOptions* options :
         {&plan.picture.emitters, &plan.second_order.emitters, &plan.antiradiance.emitters})
        change(*options);
    plan.transfer_view.picture = plan.picture;
}

// The settings of a rung.
void set(Plan& plan, const Rung& rung) {
    plan.method = rung.method;
    plan.picture = PictureOptions();
    change_emitters(plan, [&](EmitterOptions& options) {
        const PlanWish& wish = plan.wish;
        if (wish.shadow_size) options.shadow_size = *wish.shadow_size;
        if (wish.face_size) options.face_size = *wish.face_size;
        if (wish.area_samples) options.area_samples = *wish.area_samples;
    });
    plan.picture.width = plan.second_order.width = plan.wish.width;
    plan.picture.height = plan.second_order.height = plan.wish.height;
    switch (rung.method) {
        case Method::direct:
            plan.second_order.indirect = false;
            break;
        case Method::second_order:
            plan.second_order.emitters.vpls = rung.places;
            break;
        case Method::light_atlas:
            plan.vpls.count = static_cast<std::uint32_t>(rung.places);
            plan.layout.size = rung.directions;
            plan.layout.largest_size = 4096;
            break;
        case Method::antiradiance:
            plan.antiradiance.bins = rung.directions;
            plan.antiradiance.elements.wished = static_cast<std::size_t>(rung.places);
            break;
        case Method::dynamic_transfer:
            break;
    }
    apply_effects(plan);
}

struct Candidate {
    Plan plan;
    std::optional<double> error;
};

// Direct light of points and directions where there is no other, and nothing that shadows it.
bool is_exact(const Plan& plan) {
    const EffectChoice& first = plan.effects[static_cast<std::size_t>(Effect::first_bounce)];
    const bool no_bounce =
        !first.on && (first.ground == Ground::absent || first.ground == Ground::proven);
    return plan.method == Method::direct && no_bounce && !plan.on(Effect::direct_shadows) &&
           !plan.on(Effect::area_light) && !plan.on(Effect::environment_light);
}

bool fits(const cl::Device& device, const Plan& plan) {
    constexpr double share = 0.8;  // the scene is there as well
    return plan.cost.megabytes <= 1e-6 * share * device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
}

// Removes those that the device has no memory for, unless it has none for any.
void drop_too_large(const cl::Device& device, std::vector<Candidate>& candidates) {
    const auto large = [&](const Candidate& one) { return !fits(device, one.plan); };
    if (std::all_of(candidates.begin(), candidates.end(), large)) return;
    candidates.erase(std::remove_if(candidates.begin(), candidates.end(), large), candidates.end());
}

double unknown_last(const std::optional<double>& error) {
    return error ? *error : std::numeric_limits<double>::max();
}

// What is left of the time goes to the edges of direct shadows: finer maps of spots and directions,
// more points on emissive surfaces.
void spend_rest(const cl::Device& device, Plan& plan, double milliseconds) {
    const auto try_with = [&](auto&& change) {
        Plan finer = plan;
        change_emitters(finer, change);
        finer.cost = cost_of(device, finer);
        const double time = plan.wish.animated ? finer.cost.frame_ms : finer.cost.total_ms();
        if (time <= milliseconds && fits(device, finer)) plan = std::move(finer);
    };
    if (!plan.wish.shadow_size)
        for (const int size : {1024, 2048})
            try_with([&](EmitterOptions& options) { options.shadow_size = size; });
    if (!plan.wish.area_samples)
        try_with([](EmitterOptions& options) { options.area_samples = 64; });
}

}  // namespace

const char* name_of(Method method) {
    for (const Named& one : names)
        if (one.method == method) return one.name;
    return "";
}

std::optional<Method> method_of(const std::string& name) {
    for (const Named& one : names)
        if (name == one.name) return one.method;
    return std::nullopt;
}

Plan without_effect(const Plan& plan, Effect effect) {
    Plan out = plan;
    const auto off = [&](Effect which) { out.effects[static_cast<std::size_t>(which)].on = false; };
    off(effect);
    if (effect == Effect::first_bounce) {
        off(Effect::further_bounces);
        off(Effect::indirect_occlusion);
        if (plan.method != Method::dynamic_transfer) out.method = Method::direct;
    }
    apply_effects(out);
    return out;
}

void choose_method(const cl::Device& device, Plan& plan) {
    const Choice choice = methods_for(plan);
    const SceneKind kind = kind_of(plan);
    std::vector<Candidate> candidates;
    for (const Rung& rung : rungs()) {
        if (std::find(choice.methods.begin(), choice.methods.end(), rung.method) ==
            choice.methods.end())
            continue;
        Candidate one{plan, std::nullopt};
        set(one.plan, rung);
        one.plan.cost = cost_of(device, one.plan);
        const double error = rung.error[static_cast<std::size_t>(kind)];
        if (error > 0.0) one.error = error;
        if (is_exact(one.plan)) one.error = 0.0;
        candidates.push_back(std::move(one));
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
    if (wish.seconds || !wish.error) spend_rest(device, plan, milliseconds);
    plan.why = choice.why;
    plan.error = best.error;
    if (is_exact(plan))
        plan.error_ground = "there is direct light alone, and nothing that shadows it";
    else if (best.error)
        plan.error_ground = std::string("measured in ") + name_of(kind) + " scenes";
    plan.meets_time = !wish.seconds || quick(best);
    plan.meets_error = !wish.error || right(best);
    plan.unavoidable = unavoidable(plan, plan.method);
    for (EffectChoice& effect : plan.effects)
        effect.by = effect.on ? carrier_of(plan, plan.method, effect.effect).by : "";
}

}  // namespace clgi
