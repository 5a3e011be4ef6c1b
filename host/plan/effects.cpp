// SPDX-License-Identifier: MIT
#include <clgi/advanced/effects.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/survival.hpp"

namespace clgi {
namespace {

constexpr std::array<const char*, effect_count> names = {"point-light",
                                                         "spot-light",
                                                         "directional-light",
                                                         "area-light",
                                                         "environment-light",
                                                         "direct-shadows",
                                                         "environment-shadows",
                                                         "first-bounce",
                                                         "further-bounces",
                                                         "indirect-occlusion",
                                                         "gloss",
                                                         "textures",
                                                         "cutouts",
                                                         "moving-geometry",
                                                         "moving-lights"};

constexpr double unknown = std::numeric_limits<double>::infinity();

// A probe has a few thousand pixels and one unshadowed bounce. What it finds may be so many times
// too small: a margin, not a proof (docs/plan.md).
constexpr double probe_margin = 2.0;

struct Decision {
    bool on;
    Evidence evidence;
    double bound;
    std::string why;
};

Decision absent(std::string why) { return {false, Evidence::absent, 0.0, std::move(why)}; }
Decision proven(std::string why) { return {false, Evidence::proven, 0.0, std::move(why)}; }
Decision needed(std::string why) { return {true, Evidence::needed, unknown, std::move(why)}; }

Decision has(bool present, const char* what) {
    return present ? needed(std::string("the scene has ") + what)
                   : absent(std::string("the scene has no ") + what);
}

constexpr const char* no_reflection = "no surface reflects light";

bool reflects_nothing(const SceneAnalysis& analysis) {
    return analysis.surfaces.largest_albedo <= 0.0;
}

Decision direct_shadows(const SceneAnalysis& analysis) {
    if (!analysis.lights.any_direct()) return absent("no light but the environment");
    if (reflects_nothing(analysis)) return proven(no_reflection);
    if (analysis.proof.lights_open)
        return proven("the surfaces are convex: nothing lies between them and the lights");
    return needed("something may lie between a light and a surface");
}

Decision environment_shadows(const SceneAnalysis& analysis) {
    if (!analysis.lights.environment) return absent("no environment");
    if (reflects_nothing(analysis)) return proven(no_reflection);
    if (analysis.proof.environment_open)
        return proven("the surfaces are convex: nothing lies before any of them");
    return needed("something may lie before a surface");
}

// All bounces but the first: what the picture shows of the first one, or what the scene reflects
// once, whichever is more, reflected again and again by q at most. Light may come late to what the
// camera sees: from surfaces behind it, by way of others.
double further_bound(const SceneAnalysis& analysis, const ProbeResult& probe) {
    const double q = survival(analysis);
    return probe_margin * std::max(probe.first_bounce, q * probe.reflected) * q / (1.0 - q);
}

Decision first_bounce(const SceneAnalysis& analysis, double tolerance,
                      const std::optional<ProbeResult>& probe) {
    if (!analysis.lights.any_direct() && !analysis.lights.environment) return absent("no light");
    if (reflects_nothing(analysis)) return proven(no_reflection);
    if (analysis.proof.surfaces_apart) return proven("no surface faces another");
    Decision out = needed("surfaces that reflect light face each other");
    if (!probe || !bounds_indirect_light(analysis)) return out;
    const double bound = probe_margin * probe->first_bounce + further_bound(analysis, *probe);
    out.bound = bound;
    if (bound <= tolerance)
        out = {false, Evidence::measured, bound, "a probe finds less indirect light than that"};
    return out;
}

Decision further_bounces(const SceneAnalysis& analysis, double tolerance, const Decision& first,
                         const std::optional<ProbeResult>& probe) {
    if (!first.on) return {false, first.evidence, 0.0, first.why};
    Decision out = needed("light that was reflected once is reflected again");
    if (!probe || !bounds_indirect_light(analysis)) return out;
    out.bound = further_bound(analysis, *probe);
    if (out.bound <= tolerance) {
        out.on = false;
        out.evidence = Evidence::measured;
        out.why = "a probe finds little indirect light, and little of it is reflected again";
    }
    return out;
}

Decision indirect_occlusion(const SceneAnalysis& analysis, const Decision& first) {
    if (!first.on) return {false, first.evidence, 0.0, first.why};
    if (analysis.proof.surfaces_open)
        return proven("the surfaces are convex: nothing lies between two of them");
    return needed("something may lie between two surfaces");
}

}  // namespace

const char* name_of(Effect effect) { return names[static_cast<std::size_t>(effect)]; }

std::optional<Effect> effect_of(const std::string& name) {
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return static_cast<Effect>(found - names.begin());
}

const char* name_of(Evidence evidence) {
    switch (evidence) {
        case Evidence::absent:
            return "absent";
        case Evidence::proven:
            return "proven";
        case Evidence::measured:
            return "measured";
        case Evidence::needed:
            return "needed";
        case Evidence::requested:
            return "wished";
    }
    return "";
}

EffectChoices choose_effects(const SceneAnalysis& analysis, double tolerance,
                             const std::optional<ProbeResult>& probe) {
    EffectChoices out;
    const auto put = [&](Effect effect, Decision decision) {
        out[static_cast<std::size_t>(effect)] = {
            effect, decision.on, decision.evidence, decision.bound, std::move(decision.why), "",
            0.0,    0.0};
    };
    const LightAnalysis& lights = analysis.lights;
    put(Effect::point_light, has(lights.points > 0, "point lights"));
    put(Effect::spot_light, has(lights.spots > 0, "spots"));
    put(Effect::directional_light, has(lights.directional > 0, "directional lights"));
    put(Effect::area_light, has(lights.emission, "emissive surfaces"));
    put(Effect::environment_light, has(lights.environment, "environment"));
    put(Effect::direct_shadows, direct_shadows(analysis));
    put(Effect::environment_shadows, environment_shadows(analysis));
    const Decision first = first_bounce(analysis, tolerance, probe);
    put(Effect::first_bounce, first);
    put(Effect::further_bounces, further_bounces(analysis, tolerance, first, probe));
    put(Effect::indirect_occlusion, indirect_occlusion(analysis, first));
    put(Effect::gloss, has(analysis.surfaces.glossy_area > 0.0, "glossy surfaces"));
    put(Effect::textures, has(analysis.surfaces.textures, "textures of more than one colour"));
    put(Effect::cutouts,
        has(analysis.surfaces.cutouts, "alpha masks with holes, or blended surfaces"));
    put(Effect::moving_geometry, has(analysis.motion.geometry, "geometry that moves"));
    put(Effect::moving_lights, has(lights.moving, "lights that move"));
    return out;
}

}  // namespace clgi
