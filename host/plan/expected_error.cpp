// SPDX-License-Identifier: MIT
#include "plan/expected_error.hpp"

#include <algorithm>
#include <cmath>

#include "plan/settings.hpp"
#include "plan/sky.hpp"
#include "plan/static_part.hpp"

namespace clgi {
namespace {

// Of direct light where no probe was taken: about what closed rooms have.
constexpr double usual_direct_error = 0.03;
// What some hundred samples leave of it: 0.15 to 0.3 (docs/results/plans.md).
constexpr double after_samples = 0.3;

// Geometry that moves through a bake casts no indirect shadow and is lit by a few points of a
// volume: by how much that changes a picture, as measured (docs/results/plans.md). What closes an
// opening does not darken what lies behind, which is not measured.
constexpr double moving_error = 0.05;

// Shadows of suns and spots alone have one edge each, which a texel moves. One picture errs by the
// root of a texel's size; in the mean of samples, each with edges elsewhere in a pixel, the size
// itself is left.
bool has_edges_alone(const Plan& plan) {
    return (plan.on(Effect::directional_light) || plan.on(Effect::spot_light)) &&
           !plan.on(Effect::point_light) && !plan.on(Effect::area_light);
}

// Each point lights what is close to it as a disc as large as its share of the lamp does, in all
// samples: of strips along a wall 0.6 of the light were lost, and a probe of twice as many points
// knew nothing of it (docs/results/plans.md).
constexpr double of_large_lamps = 1.0;

double direct_error(const Plan& plan) {
    if (has_exact_direct_light(plan)) return 0.0;
    const bool by_points = plan.method != Method::irradiance_cache && !plan.request.method;
    if (by_points && points_are_large(plan)) return of_large_lamps;
    const double usual = plan.probe ? plan.probe->direct_error : usual_direct_error;
    const double fineness = fineness_of(plan);
    if (!plan.request.refined) return usual / std::sqrt(fineness);
    return after_samples * usual / (has_edges_alone(plan) ? fineness : std::sqrt(fineness));
}

// Lobes as wide as a bin, which glossy leaves alone have: `glossy-box` and `glossy-bust-like` erred
// as if 0.6 and 0.2 of what lobes reflect were lost.
constexpr double lost_in_bins = 0.4;

// Of indirect light, what lobes would reflect of it.
double lost_gloss(const Plan& plan) {
    if (!plan.on(Effect::gloss) || plan.method == Method::irradiance_cache) return 0.0;
    const double lost = plan.method == Method::antiradiance ? lost_in_bins : 1.0;
    return lost * (plan.reach && plan.reach->points > 0 ? plan.reach->gloss
                                                        : plan.analysis.surfaces.gloss);
}

std::optional<double> indirect_error(const Plan& plan, double of_kind) {
    if (!plan.on(Effect::first_bounce)) {
        const EffectChoice& first = plan.effects[static_cast<std::size_t>(Effect::first_bounce)];
        return first.bound;
    }
    if (!(of_kind > 0.0)) return std::nullopt;
    return std::hypot(doubt_factor(plan) * of_kind, lost_gloss(plan)) * indirect_share(plan);
}

}  // namespace

bool has_exact_direct_light(const Plan& plan) {
    if (!(plan.analysis.surfaces.largest_albedo > 0.0)) return true;  // none is
    return !plan.on(Effect::direct_shadows) && !plan.on(Effect::area_light) &&
           !plan.on(Effect::environment_light);
}

bool gathers_the_sky(const Plan& plan) {
    return plan.method == Method::dynamic_transfer ||
           (plan.method == Method::irradiance_cache && has_sky(plan));
}

double doubt_factor(const Plan& plan) {
    double out = 1.0;
    const double share = indirect_share(plan);
    for (const PlanCheck& check : plan.checks) {
        if (check.found.error) return 1.0;
        if (check.found.doubt && check.indirect && share > 0.0)
            out = std::max(1.0, *check.found.doubt / (*check.indirect * share));
    }
    return out;
}

std::optional<double> expected_error(const Plan& plan, double of_kind) {
    if (gathers_the_sky(plan)) return of_kind > 0.0 ? std::optional(of_kind) : std::nullopt;
    // A few lights for the whole sky: not measured.
    if (plan.method == Method::direct && has_sky(plan)) return std::nullopt;
    const std::optional<double> indirect = indirect_error(plan, of_kind);
    if (!indirect) return std::nullopt;
    const double out =
        std::hypot(*indirect, direct_error(plan), is_composed(plan) ? moving_error : 0.0);
    if (!std::isfinite(out)) return std::nullopt;  // the probe saw no light
    return out;
}

bool left_out_by_request(const Plan& plan) {
    return std::any_of(plan.effects.begin(), plan.effects.end(), [](const EffectChoice& choice) {
        return !choice.on && choice.evidence == Evidence::requested;
    });
}

std::string evidence_of_error(const Plan& plan) {
    const std::string kind = name_of(kind_of(plan));
    if (gathers_the_sky(plan)) return "measured in " + kind + " scenes";
    const std::string direct = has_exact_direct_light(plan) ? "direct light is exact"
                               : plan.probe                 ? "direct light by a probe"
                                                            : "direct light as in closed rooms";
    if (!plan.on(Effect::first_bounce)) return direct;
    const bool seen = doubt_factor(plan) > 1.0;
    return (seen ? "indirect light by how records of a picture differ, "
                 : "indirect light as measured in " + kind + " scenes, ") +
           (is_composed(plan)
                ? "of what moves as in an office (behind a closing door it is up to all "
                  "of the light there), "
                : "") +
           direct;
}

}  // namespace clgi
