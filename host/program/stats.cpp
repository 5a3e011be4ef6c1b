// SPDX-License-Identifier: MIT
#include "program/stats.hpp"

#include <clgi/device.hpp>
#include <map>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "program/plan_text.hpp"
#include "program/verify.hpp"
#include "program/version.hpp"

namespace clgi::program {
namespace {

using nlohmann::ordered_json;

ordered_json device_json(const cl::Device& device) {
    return {{"name", device.getInfo<CL_DEVICE_NAME>()},
            {"version", device.getInfo<CL_DEVICE_VERSION>()},
            {"driver", device.getInfo<CL_DRIVER_VERSION>()},
            {"compute_units", device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()},
            {"packet_width", packet_width(device)}};
}

ordered_json passes_json(const std::vector<std::vector<lab::PassTime>>& frames) {
    ordered_json out = ordered_json::array();
    if (frames.empty()) return out;
    for (const lab::PassTime& pass : frames.back()) {
        std::vector<double> times;
        for (const auto& frame : frames)
            for (const lab::PassTime& other : frame)
                if (other.name == pass.name) times.push_back(other.milliseconds);
        out.push_back(
            {{"name", pass.name}, {"ms_median", lab::spread(times).median}, {"items", pass.items}});
    }
    return out;
}

ordered_json attempts_json(const RenderRecord& record) {
    ordered_json attempts = ordered_json::array();
    for (const RenderedAttempt& one : record.attempts) {
        attempts.push_back(
            {{"settings", one.settings}, {"seconds", one.seconds}, {"refine_ms", one.refine_ms}});
        if (one.expected) attempts.back()["expected"] = *one.expected;
        if (one.verified) attempts.back()["measured_error"] = picture_json(*one.verified);
    }
    return attempts;
}

}  // namespace

void save_stats(const RenderRecord& record, const std::filesystem::path& path) {
    const lab::Spread frame = lab::spread(record.frame_ms);
    ordered_json out = {
        {"clgi", CLGI_VERSION},
        {"device", device_json(record.device)},
        {"math", record.build.math == Math::fast ? "fast" : "strict"},
        {"storage", record.build.storage == Storage::half ? "half" : "full"},
        {"method", record.method},
        {"scene", {{"triangles", record.triangles}, {"lights", record.lights}}},
        {"effects", record.effects},
        {"frames", record.frame_ms.size()},
        {"frame_ms", {{"min", frame.min}, {"median", frame.median}, {"max", frame.max}}},
        {"samples", {{"count", record.samples}, {"refine_ms", record.refine_ms}}},
        {"passes", passes_json(record.passes)},
        {"memory_mb", static_cast<double>(record.bytes) / 1e6},
        {"build_ms", record.build_ms},
        {"low_res_share", record.status.low_resolution_share},
        {"non_finite", record.status.non_finite},
        {"converged", !record.antiradiance || record.antiradiance->converged},
        {"warnings", record.warnings}};
    if (record.gbuffer == "gl")
        out["gbuffer"] = {{"by", "gl"}, {"renderer", record.gl_renderer}, {"path", record.gl_path}};
    else
        out["gbuffer"] = {{"by", record.gbuffer}};
    if (record.replicates)
        out["replicates"] = {{"count", record.replicates->count},
                             {"error", record.replicates->error},
                             {"single_error", record.replicates->single_error}};
    if (record.bake)
        out["bake"] = {{"vpls", record.bake->vpls},           {"texels", record.bake->texels},
                       {"pages", record.bake->pages},         {"atlas_size", record.bake->size},
                       {"layout_ms", record.bake->layout_ms}, {"bake_ms", record.prepare_ms}};
    if (record.transfer)
        out["transfer"] = {{"receivers", record.transfer->receivers},
                           {"triangles", record.transfer->triangles},
                           {"terms", record.transfer->terms},
                           {"receiver_pixels", record.transfer->receiver_pixels}};
    if (record.cache)
        out["cache"] = {
            {"seen", record.cache->seen},           {"met", record.cache->met},
            {"refined", record.cache->refined},     {"spots", record.cache->spots},
            {"reflections", record.cache->bounces}, {"converged", record.cache->converged}};
    if (record.antiradiance) {
        const AntiradianceSummary& a = *record.antiradiance;
        out["antiradiance"] = {{"elements", a.elements},
                               {"leaves", a.leaves},
                               {"links", a.links},
                               {"moving_links", a.moving_links},
                               {"bins", a.bins},
                               {"lets_through", a.lets_through},
                               {"iteration", a.iteration},
                               {"diverged", a.diverged},
                               {"given_up", a.given_up_frames > 0},
                               {"given_up_frames", a.given_up_frames},
                               {"converged", a.converged},
                               {"steps", a.steps},
                               {"residual", a.residual},
                               {"linking_ms", a.linking_ms}};
    }
    if (record.planned) {
        out["plan"] = plan_json(record.planned->plan);
        out["plan"]["ms"] = record.planned->milliseconds;
    }
    if (record.budget_used)
        out["time_budget"] = {{"seconds", *record.planned->plan.request.seconds},
                              {"used", *record.budget_used},
                              {"attempts", attempts_json(record)}};
    else if (!record.attempts.empty())
        out["target"] = {{"error", *record.planned->plan.request.error},
                         {"met", record.meets_target},
                         {"attempts", attempts_json(record)}};
    if (record.ask) out["ask"] = ask_json(*record.ask, frame.median);
    if (record.expected_error) out["expected_error"] = *record.expected_error;
    if (record.verified) out["measured_error"] = picture_json(*record.verified);
    io::AtomicFile file(path);
    const std::string text = out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + '\n';
    file.write(text.data(), text.size());
    file.commit();
}

}  // namespace clgi::program
