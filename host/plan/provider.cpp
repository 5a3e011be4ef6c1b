// SPDX-License-Identifier: MIT
#include "plan/provider.hpp"

#include "plan/sky.hpp"
#include "plan/static_part.hpp"

namespace clgi {
namespace {

constexpr Provider nothing{"nothing"};

// VPLs of second order are placed through the shadow maps, which then shadow direct light too.
bool places_by_maps(const Plan& plan, Method method) {
    return method == Method::second_order && plan.on(Effect::first_bounce);
}

Provider environment_light(Method method) {
    if (has_sky_lights(method)) return {"directional lights"};
    if (method == Method::irradiance_cache) return {"hemicubes"};
    return {method == Method::antiradiance ? "links from the sky" : "transfer vectors"};
}

Provider direct_shadows(const Plan& plan, Method method) {
    const bool of_sky =
        has_sky_lights(method) && has_sky(plan) && plan.on(Effect::environment_shadows);
    return {"shadow maps", of_sky || places_by_maps(plan, method)};
}

Provider environment_shadows(const Plan& plan, Method method) {
    if (method == Method::antiradiance) return {"antiradiance", true};
    if (method == Method::dynamic_transfer) return {"masks"};
    if (method == Method::irradiance_cache) return {"hemicubes", true};
    const bool of_lights = plan.analysis.lights.any_direct() && plan.on(Effect::direct_shadows);
    return {"shadow maps", of_lights || places_by_maps(plan, method)};
}

// Of the static part, and of what moves.
Provider baked(const Plan& plan) {
    return {bakes_static_part(plan) ? "baked VPLs; moving: volume" : "baked VPLs"};
}

Provider first_bounce(const Plan& plan, Method method) {
    switch (method) {
        case Method::direct:
            return nothing;
        case Method::second_order:
            return {"VPLs"};
        case Method::light_atlas:
            return baked(plan);
        case Method::antiradiance:
            return {"links", true};
        case Method::dynamic_transfer:  // reflections go where masks are covered
            return plan.on(Effect::environment_shadows) ? Provider{"masks"} : nothing;
        case Method::irradiance_cache:
            return {"hemicubes", true};
    }
    return nothing;
}

Provider further_bounces(const Plan& plan, Method method) {
    if (method == Method::light_atlas) return baked(plan);
    if (method == Method::antiradiance) return {"links", true};
    if (method == Method::irradiance_cache) return {"hemicubes"};
    return nothing;
}

Provider indirect_occlusion(Method method) {
    switch (method) {
        case Method::direct:
            return nothing;
        case Method::second_order:
            return {"negative VPLs"};
        case Method::light_atlas:
            return {"hemicubes"};
        case Method::antiradiance:
            return {"antiradiance", true};
        case Method::dynamic_transfer:
            return {"masks", true};
        case Method::irradiance_cache:
            return {"hemicubes", true};
    }
    return nothing;
}

}  // namespace

Provider provider_of(const Plan& plan, Method method, Effect effect) {
    switch (effect) {
        case Effect::point_light:
        case Effect::spot_light:
        case Effect::directional_light:
        case Effect::area_light:
            return {"direct light"};
        case Effect::environment_light:
            return environment_light(method);
        case Effect::direct_shadows:
            return direct_shadows(plan, method);
        case Effect::environment_shadows:
            return environment_shadows(plan, method);
        case Effect::first_bounce:
            return first_bounce(plan, method);
        case Effect::further_bounces:
            return further_bounces(plan, method);
        case Effect::indirect_occlusion:
            return indirect_occlusion(method);
        case Effect::gloss:
            if (method == Method::antiradiance) return {"direct light, glossy leaves"};
            if (method == Method::irradiance_cache) return {"direct light, hemicubes"};
            if (method == Method::dynamic_transfer) return {"direct light, masks of pixels"};
            return {"direct light"};  // indirect light is diffuse
        case Effect::textures:
            return {"all passes"};
        case Effect::cutouts:
            if (method == Method::antiradiance || method == Method::dynamic_transfer)
                return {"camera and shadow maps"};  // links and masks see whole triangles
            return {"all passes"};
        case Effect::moving_geometry:
        case Effect::moving_lights:
            if (method == Method::light_atlas && effect == Effect::moving_geometry)
                return bakes_static_part(plan) ? Provider{"direct light, volume"} : nothing;
            return {"all passes"};
    }
    return nothing;
}

std::vector<Effect> unavoidable(const Plan& plan, Method method) {
    std::vector<Effect> out;
    for (const EffectChoice& choice : plan.effects)
        if (!choice.on && choice.evidence == Evidence::requested &&
            provider_of(plan, method, choice.effect).always)
            out.push_back(choice.effect);
    return out;
}

}  // namespace clgi
