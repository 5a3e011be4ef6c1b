// SPDX-License-Identifier: MIT
#include "program/plan_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace clgi::program {
namespace {

using nlohmann::ordered_json;

std::string bound_text(const EffectChoice& choice) {
    return std::isinf(choice.bound) ? "unknown" : fmt::format("{:.2g} %", 100.0 * choice.bound);
}

ordered_json effect_names(const std::vector<Effect>& effects) {
    ordered_json out = ordered_json::array();
    for (const Effect effect : effects) out.push_back(name_of(effect));
    return out;
}

// JSON has no infinity.
ordered_json number(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

std::string settings_text(const Plan& plan) {
    switch (plan.method) {
        case Method::direct:
            return "no indirect light";
        case Method::second_order:
            return fmt::format("{} VPLs, {} negative", plan.second_order.emitters.vpls,
                               plan.second_order.negative_vpls);
        case Method::light_atlas:
            return fmt::format("{} VPLs, pages of {} texels", plan.vpls.count, plan.layout.size);
        case Method::antiradiance:
            return fmt::format("{} bins, {} leaves wished", plan.antiradiance.bins,
                               plan.antiradiance.elements.requested);
        case Method::dynamic_transfer:
            return fmt::format("{} bands, {} bounces", plan.transfer.masks.bands,
                               plan.transfer.interreflections);
        case Method::irradiance_cache:
            return fmt::format("{}, {} and {} records, hemicubes of {} pixels", plan.cache.seen,
                               plan.cache.met, plan.cache.refined, plan.cache.face);
    }
    return "";
}

ordered_json settings_json(const Plan& plan) {
    switch (plan.method) {
        case Method::direct:
            return ordered_json::object();
        case Method::second_order:
            return {{"vpls", plan.second_order.emitters.vpls},
                    {"negative_vpls", plan.second_order.negative_vpls}};
        case Method::light_atlas:
            return {{"vpls", plan.vpls.count},
                    {"atlas_size", plan.layout.size},
                    {"bounces", plan.light_atlas.bounces}};
        case Method::antiradiance:
            return {{"bins", plan.antiradiance.bins},
                    {"elements", plan.antiradiance.elements.requested},
                    {"iterations", plan.antiradiance.steps},
                    {"occlusion", plan.antiradiance.occlusion == Occlusion::always},
                    {"gloss", plan.antiradiance.least_gloss < 1.0}};
        case Method::dynamic_transfer:
            return {{"bands", plan.transfer.masks.bands},
                    {"interreflections", plan.transfer.interreflections},
                    {"gloss", plan.transfer.gloss},
                    {"shadowed", occludes(plan.transfer.occlusion)}};
        case Method::irradiance_cache:
            return {{"seen", plan.cache.seen},
                    {"met", plan.cache.met},
                    {"refined", plan.cache.refined},
                    {"face", plan.cache.face},
                    {"emission", plan.cache.emission}};
    }
    return ordered_json::object();
}

// Of direct light in the picture.
ordered_json emitters_json(const Plan& plan) {
    const EmitterOptions& options =
        plan.method == Method::second_order ? plan.second_order.emitters : plan.picture.emitters;
    return {{"shadows", options.shadows},
            {"shadow_size", options.shadow_size},
            {"face_size", options.face_size},
            {"area_samples", options.area_samples}};
}

ordered_json effects_json(const Plan& plan) {
    ordered_json out = ordered_json::array();
    for (const EffectChoice& choice : plan.effects)
        out.push_back({{"name", name_of(choice.effect)},
                       {"on", choice.on},
                       {"ground", name_of(choice.evidence)},
                       {"why", choice.why},
                       {"by", choice.by},
                       {"ms", choice.milliseconds},
                       {"mb", choice.megabytes},
                       {"bound", number(choice.bound)}});
    return out;
}

ordered_json analysis_json(const SceneAnalysis& analysis) {
    const LightAnalysis& l = analysis.lights;
    const SurfaceAnalysis& s = analysis.surfaces;
    const OpennessProof& p = analysis.proof;
    return {{"triangles", s.triangles},
            {"area", s.area},
            {"largest_albedo", s.largest_albedo},
            {"gloss", s.gloss},
            {"glossy_area", s.glossy_area},
            {"double_sided_area", s.double_sided_area},
            {"textures", s.textures},
            {"cutouts", s.cutouts},
            {"vertices", s.vertices},
            {"degenerate", s.degenerate},
            {"lights",
             {{"points", l.points},
              {"spots", l.spots},
              {"directional", l.directional},
              {"emissive_triangles", l.emissive_triangles},
              {"environment", l.environment},
              {"moving", l.moving}}},
            {"moving_area", analysis.motion.moving_area},
            {"moving_emission", analysis.motion.moving_emission},
            {"openness", analysis.openness},
            {"proven",
             {{"surfaces_open", p.surfaces_open},
              {"surfaces_apart", p.surfaces_apart},
              {"lights_open", p.lights_open},
              {"environment_open", p.environment_open}}},
            {"ms", analysis.milliseconds}};
}

}  // namespace

std::string plan_settings(const Plan& plan) {
    return fmt::format("{} ({})", name_of(plan.method), settings_text(plan));
}

std::string plan_line(const Plan& plan) {
    std::string out = fmt::format(
        "{}: {}; predicted {:.3g} ms before the first picture, {:.3g} ms a picture, {:.0f} MB",
        plan_settings(plan), plan.why, plan.cost.once_ms, plan.cost.frame_ms, plan.cost.megabytes);
    if (plan.error)
        out +=
            fmt::format("; error about {} % ({})", about_percent(*plan.error), plan.error_evidence);
    return out;
}

std::string plan_text(const Plan& plan) {
    const auto line = [](const char* effect, const char* on, const std::string& ms,
                         const std::string& mb, const std::string& bound, const std::string& by,
                         const std::string& why) {
        return fmt::format("{:<20} {:>4} {:>8} {:>7} {:>8}  {:<27} {}\n", effect, on, ms, mb, bound,
                           by, why);
    };
    std::string out = line("effect", "", "ms", "MB", "bound", "by", "why");
    for (const EffectChoice& choice : plan.effects)
        out += line(name_of(choice.effect), choice.on ? "on" : "off",
                    choice.on ? fmt::format("{:.1f}", choice.milliseconds) : "",
                    choice.on ? fmt::format("{:.1f}", choice.megabytes) : "", bound_text(choice),
                    choice.by, choice.why);
    for (const Effect effect : plan.unavoidable)
        out += fmt::format("{} is rendered all the same\n", name_of(effect));
    return out + plan_line(plan) + "\n";
}

ordered_json plan_json(const Plan& plan) {
    ordered_json request = {{"width", plan.request.width},
                            {"height", plan.request.height},
                            {"tolerance", plan.request.tolerance}};
    if (plan.request.seconds) request["seconds"] = *plan.request.seconds;
    if (plan.request.error) request["error"] = *plan.request.error;
    if (plan.request.method) request["method"] = name_of(*plan.request.method);
    if (plan.request.animated) request["animated"] = true;
    if (!plan.request.with.empty()) request["with"] = effect_names(plan.request.with);
    if (!plan.request.without.empty()) request["without"] = effect_names(plan.request.without);
    ordered_json out = {{"wish", request},
                        {"facts", analysis_json(plan.analysis)},
                        {"effects", effects_json(plan)},
                        {"bound", number(plan.bound)},
                        {"method", name_of(plan.method)},
                        {"why", plan.why},
                        {"settings", settings_json(plan)},
                        {"direct_light", emitters_json(plan)},
                        {"once_ms", plan.cost.once_ms},
                        {"frame_ms", plan.cost.frame_ms},
                        {"memory_mb", plan.cost.megabytes},
                        {"meets_time", plan.meets_time},
                        {"meets_error", plan.meets_error}};
    if (plan.error) {
        out["error"] = *plan.error;
        out["error_ground"] = plan.error_evidence;
    }
    if (!plan.unavoidable.empty()) out["unavoidable"] = effect_names(plan.unavoidable);
    if (plan.reach)
        out["reach"] = {{"radius", plan.reach->sphere.radius},
                        {"size", plan.reach->size},
                        {"area", plan.reach->area},
                        {"power", plan.reach->power},
                        {"emissive_area", plan.reach->emissive_area},
                        {"hidden", plan.reach->hidden},
                        {"open", plan.reach->open},
                        {"cone", plan.reach->cone},
                        {"gloss", plan.reach->gloss},
                        {"points", plan.reach->points},
                        {"ms", plan.reach->milliseconds}};
    if (plan.probe)
        out["probe"] = {{"first_bounce", number(plan.probe->first_bounce)},
                        {"reflected", number(plan.probe->reflected)},
                        {"direct_error", number(plan.probe->direct_error)},
                        {"ms", plan.probe->milliseconds}};
    return out;
}

}  // namespace clgi::program
