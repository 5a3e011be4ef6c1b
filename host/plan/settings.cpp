// SPDX-License-Identifier: MIT
#include "plan/settings.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/opencl/variants.hpp"
#include "plan/reach.hpp"
#include "plan/sky.hpp"

namespace clgi {
namespace {

// Brings the settings to the effects: what is off is switched off.
void apply_effects(Plan& plan) {
    const BuildOptions& build = plan.request.build;
    const bool shadows =
        plan.on(Effect::direct_shadows) ||
        (has_sky_lights(plan.method) && has_sky(plan) && plan.on(Effect::environment_shadows));
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
    plan.light_atlas.occlusion =
        plan.on(Effect::indirect_occlusion) ? Occlusion::automatic : Occlusion::none;
    plan.light_atlas.build = full(build);

    emitters(plan.antiradiance.emitters);
    if (!plan.on(Effect::gloss)) plan.antiradiance.least_gloss = 1.0;
    const EffectChoice& occlusion =
        plan.effects[static_cast<std::size_t>(Effect::indirect_occlusion)];
    plan.antiradiance.occlusion = occlusion.on && occlusion.evidence == Evidence::requested
                                      ? Occlusion::always
                                      : Occlusion::automatic;
    plan.antiradiance.build = build;

    DynamicTransferOptions& transfer = plan.transfer;
    transfer.occlusion =
        plan.on(Effect::environment_shadows) ? Occlusion::automatic : Occlusion::none;
    transfer.gloss = plan.on(Effect::gloss);
    transfer.interreflections =
        plan.on(Effect::first_bounce) && occludes(transfer.occlusion) ? 1 : 0;
    transfer.build = build;
    plan.transfer_view.picture = plan.picture;
}

// Those of everything that draws shadow maps.
template <typename Change>
void change_emitters(Plan& plan, const Change& change) {
    for (EmitterOptions* options : {&plan.picture.emitters, &plan.second_order.emitters,
                                    &plan.light_atlas.emitters, &plan.antiradiance.emitters})
        change(*options);
    plan.transfer_view.picture = plan.picture;
}

// Whether most points on emissive surfaces would lie where the picture does not reach: hemicubes
// see the others.
bool lamps_are_hidden(const Plan& plan) {
    constexpr double few = 0.3;
    return plan.on(Effect::area_light) && plan.reach && plan.reach->hidden > few;
}

int as_fine(double fineness, int usual) {
    return static_cast<int>(std::max(fineness, 1.0) * usual);
}

// Side of shadow maps. Of few suns and spots, a texel is a third of what a pixel covers: edges are
// two texels wide.
int map_side(const Plan& plan, double fineness) {
    constexpr int step = 256;
    constexpr double texels = 3.0;           // a pixel
    constexpr double most_pixels = 1 << 25;  // of all maps
    constexpr std::size_t few = 4;
    const int usual = as_fine(fineness, EmitterOptions().shadow_size);
    const Reach reach = plan.reach.value_or(Reach());
    const LightAnalysis& lights = plan.analysis.lights;
    const bool suns = plan.on(Effect::directional_light) && lights.directional > 0;
    const bool spots = plan.on(Effect::spot_light) && lights.spots > 0;
    const bool many =
        (has_sky(plan) && has_sky_lights(plan.method)) || lights.directional + lights.spots > few;
    const bool frames = plan.request.animated || plan.request.lights_change;
    if ((!suns && !spots) || many || frames || !(reach.pixel > 0.0)) return usual;
    const SunMaps suns_have = sun_maps(reach);
    const auto maps = static_cast<double>(suns_have.count * lights.directional + lights.spots);
    const double most = std::min(4096.0, step * std::floor(std::sqrt(most_pixels / maps) / step));
    const double across = std::max(suns ? 2.0 * suns_have.radius : 0.0, spots ? reach.cone : 0.0);
    const double wanted = texels * across / reach.pixel;
    const double side = std::min(wanted, most) * std::min(fineness, 1.0);
    return std::max(usual, step * static_cast<int>(std::ceil(side / step)));
}

// What suns and spots light in finely modelled scenes is seen by records, unless it lies behind a
// hole: few of them are not worth the search for small places. Lamps that shine all around stand in
// shades.
constexpr int many_places = 600;
bool has_no_lamps(const Plan& plan) { return is_fine(plan) && plan.analysis.lights.points == 0; }

// The settings of a preset.
void use_preset(Plan& plan, const Preset& preset) {
    plan.picture.width = plan.second_order.width = plan.request.width;
    plan.picture.height = plan.second_order.height = plan.request.height;
    switch (preset.method) {
        case Method::direct:
            plan.second_order.indirect = false;
            break;
        case Method::second_order:
            plan.second_order.emitters.vpls = preset.places;
            break;
        case Method::light_atlas:
            plan.vpls.count = static_cast<std::uint32_t>(preset.places);
            plan.layout.size = preset.directions;
            plan.layout.largest_size = 4096;
            break;
        case Method::antiradiance:
            plan.antiradiance.bins = preset.directions;
            plan.antiradiance.elements.requested = static_cast<std::size_t>(preset.places);
            break;
        case Method::dynamic_transfer:
            break;
        case Method::irradiance_cache:
            plan.cache.emission = points_are_large(plan) || lamps_are_hidden(plan);
            plan.cache.seen = preset.places;
            // Finely modelled surfaces differ more among themselves than what lights them does, and
            // what lamps and suns light near them differs from place to place.
            plan.cache.met = (is_fine(plan) ? 1 : 3) * preset.places;
            plan.cache.refined = (is_fine(plan) && !has_sky(plan) ? 4 : 1) * preset.places;
            plan.cache.face = preset.directions;
            if (has_no_lamps(plan) && preset.places < many_places) plan.cache.spots = 0;
            break;
    }
}

}  // namespace

bool points_are_large(const Plan& plan) {
    constexpr double small = 0.06;
    if (!plan.on(Effect::area_light) || !plan.reach || plan.reach->points == 0) return false;
    const double point = std::sqrt(plan.reach->emissive_area /
                                   (std::numbers::pi * plan.picture.emitters.area_samples));
    return point > small * plan.reach->sphere.radius;
}

void set(Plan& plan, const Preset& preset, double fineness) {
    const PlanRequest& request = plan.request;
    plan.method = preset.method;
    plan.animated = request.animated;
    plan.picture = PictureOptions();
    change_emitters(plan, [&](EmitterOptions& options) {
        options.shadow_size = request.shadow_size.value_or(map_side(plan, fineness));
        options.face_size =
            request.face_size.value_or(as_fine(fineness, EmitterOptions().face_size));
        options.area_samples =
            request.area_samples.value_or(as_fine(fineness, EmitterOptions().area_samples));
    });
    use_preset(plan, preset);
    apply_effects(plan);
}

double fineness_of(const Plan& plan) {
    const EmitterOptions usual, &options = plan.picture.emitters;
    double out = std::numeric_limits<double>::infinity();
    const auto at_most = [&](int is, int was) {
        out = std::min(out, static_cast<double>(is) / was);
    };
    if (plan.on(Effect::spot_light) || plan.on(Effect::directional_light) || has_sky(plan))
        at_most(options.shadow_size, usual.shadow_size);
    if (plan.on(Effect::point_light) || plan.on(Effect::area_light))
        at_most(options.face_size, usual.face_size);
    if (plan.on(Effect::area_light)) at_most(options.area_samples, usual.area_samples);
    return std::isfinite(out) ? out : 1.0;
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

}  // namespace clgi
