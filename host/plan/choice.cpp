// SPDX-License-Identifier: MIT
#include "plan/choice.hpp"

#include <algorithm>

#include "plan/openness.hpp"
#include "plan/provider.hpp"
#include "plan/sky.hpp"
#include "plan/static_part.hpp"

namespace clgi {
namespace {

constexpr double noticeable = 0.02;  // of the light that surfaces reflect, as gloss
constexpr double few_backs = 0.05;   // of the area, double-sided
constexpr double elsewhere = 10.0;   // what surfaces reflect, over what the picture shows
// Beyond so many triangles, links for all poses take minutes.
constexpr std::size_t most_moving_triangles = 30000;
// With more glossy triangles, each of which may be a leaf, a picture takes seconds.
constexpr std::size_t most_glossy_triangles = 20000;
// What moves casts no indirect shadow and reflects nothing onto what a bake holds.
constexpr double little_moves = 0.1;  // of the area

// Whether a bake of the static part lights the scene while the rest moves through it.
bool bakes_the_rest(const Plan& plan) {
    const MotionAnalysis& motion = plan.analysis.motion;
    return bakes_static_part(plan) && !plan.on(Effect::moving_lights) &&
           !plan.request.lights_change && !motion.moving_emission &&
           motion.moving_area <= little_moves;
}

Choice candidates_for(const Plan& plan) {
    const SceneAnalysis& analysis = plan.analysis;
    const bool sky = has_sky(plan);
    const bool sky_alone = sky && !analysis.lights.any_direct() && analysis.openness > mostly_open;
    if (analysis.surfaces.triangles <= analysis.surfaces.degenerate)
        return {{Method::direct}, "there are no surfaces"};
    if (!plan.on(Effect::first_bounce)) {
        if (!sky) return {{Method::direct}, "there is no indirect light"};
        return {{Method::dynamic_transfer, Method::direct}, "there is the sky's light alone"};
    }
    if (plan.request.animated) {
        if (sky_alone) return {{Method::dynamic_transfer}, "the environment lights what moves"};
        Choice out{{Method::second_order}, "nothing is made before, and there are many triangles"};
        if (analysis.surfaces.triangles <= most_moving_triangles)
            out = {{Method::antiradiance, Method::second_order}, "light follows what moves"};
        if (bakes_the_rest(plan)) out.methods.push_back(Method::light_atlas);
        return out;
    }
    if (sky) return {{Method::irradiance_cache}, "the sky lights what the picture sees"};
    if (sees_little(plan))
        return {{Method::irradiance_cache}, "the picture sees a small part of the scene"};
    if (plan.probe && plan.probe->reflected > elsewhere)
        return {{Method::irradiance_cache}, "little of the light reaches the picture"};
    Choice out{{Method::second_order, Method::light_atlas, Method::irradiance_cache},
               "light goes on between surfaces"};
    const bool glossy = analysis.surfaces.gloss > noticeable && plan.on(Effect::gloss);
    if (!glossy || analysis.surfaces.triangles <= most_glossy_triangles)
        out.methods.push_back(Method::antiradiance);
    return out;
}

// Whether a method has all effects that are on, and can leave out those that are off by request.
bool suits(Method method, const Plan& plan) {
    if (!unavoidable(plan, method).empty()) return false;
    switch (method) {
        case Method::direct:
        case Method::second_order:
            return true;
        case Method::light_atlas:  // has one light for both sides of a surface
            return plan.analysis.surfaces.double_sided_area <= few_backs;
        case Method::antiradiance:  // masked and blended surfaces block as a whole; all bounces
                                    // come together
            return !plan.on(Effect::cutouts) &&
                   (!plan.on(Effect::first_bounce) || plan.on(Effect::further_bounces));
        case Method::dynamic_transfer:
            return !plan.on(Effect::cutouts);
        case Method::irradiance_cache:
            return true;
    }
    return true;
}

}  // namespace

Choice methods_for(const Plan& plan) {
    if (plan.request.method) return {{*plan.request.method}, "asked for"};
    Choice out = candidates_for(plan);
    std::vector<Method> suitable;
    for (const Method method : out.methods)
        if (suits(method, plan)) suitable.push_back(method);
    // If no candidate is suitable, one of the other methods may be.
    const bool indirect = plan.on(Effect::first_bounce);
    if (suitable.empty() && indirect && !plan.request.animated && suits(Method::light_atlas, plan))
        suitable = {Method::light_atlas};
    if (suitable.empty()) suitable = {indirect ? Method::second_order : Method::direct};
    out.methods = std::move(suitable);
    return out;
}

}  // namespace clgi
