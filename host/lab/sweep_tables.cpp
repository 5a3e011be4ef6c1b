// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "lab/sweep_atlas.hpp"
#include "lab/sweep_files.hpp"
#include "lab/sweep_summary.hpp"

namespace clgi::lab {
namespace {

std::string knob(const SweepPoint& point, const std::string& name) {
    const auto found = point.knobs.find(name);
    return found == point.knobs.end() ? "" : found->second;
}

template <typename Is>
bool any(const Sweep& sweep, const Is& is) {
    return std::any_of(sweep.points.begin(), sweep.points.end(), is);
}

}  // namespace

std::string sweep_csv(const Sweep& sweep) {
    std::string out = "method,series";
    for (const std::string& name : sweep.knobs) out += fmt::format(",{}", name);
    const bool once =
        any(sweep, [](const SweepPoint& p) { return p.once_milliseconds.has_value(); });
    std::vector<bool> estimated;  // [truths]
    for (const SweepTruth& truth : sweep.truths)
        estimated.push_back(any(sweep, [&](const SweepPoint& p) {
            return p.estimated_error.find(truth.name) != p.estimated_error.end();
        }));
    out += once ? ",ms,once ms" : ",ms";
    for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
        out += fmt::format(",error {0},front {0}", sweep.truths[t].name);
        if (estimated[t]) out += fmt::format(",estimated_error {}", sweep.truths[t].name);
    }
    const bool given_up = any(sweep, [](const SweepPoint& p) { return p.given_up; });
    out += given_up ? ",energy ratio,given_up\n" : ",energy ratio\n";
    for (const SweepPoint& point : sweep.points) {
        out += fmt::format("{},\"{}\"", point.method, point.series);
        for (const std::string& name : sweep.knobs) out += "," + knob(point, name);
        out += fmt::format(",{:.4g}", point.milliseconds);
        if (once)
            out += "," +
                   (point.once_milliseconds ? fmt::format("{:.4g}", *point.once_milliseconds) : "");
        for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
            out += fmt::format(",{:.6g},{}", point.error[t], point.front[t] ? 1 : 0);
            const auto found = point.estimated_error.find(sweep.truths[t].name);
            if (estimated[t])
                out += found == point.estimated_error.end() ? ","
                                                            : fmt::format(",{:.6g}", found->second);
        }
        out += fmt::format(",{:.6g}", point.energy);
        out += given_up ? point.given_up ? ",1\n" : ",0\n" : "\n";
    }
    return out;
}

std::string sweep_json(const Sweep& sweep, const SweepNote& note) {
    nlohmann::ordered_json out = {
        {"clgi", note.version},
        {"command", note.command},
        {"device", sweep.device},
        {"scene", {{"name", sweep.scene}, {"triangles", sweep.triangles}}},
        {"size", {sweep.width, sweep.height}},
        {"summary", summary(sweep)}};
    for (const SweepTruth& truth : sweep.truths)
        out["references"].push_back(
            {{"name", truth.name}, {"effects", truth.effects}, {"standard_error", truth.noise}});
    for (const std::string& method : sweep.methods)
        for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
            const Speedup factor = speedup(sweep, method, t);
            out["speedups"].push_back({{"method", factor.method},
                                       {"reference", sweep.truths[t].name},
                                       {"at_least_error", factor.at_least_error},
                                       {"least_error", factor.least_error},
                                       {"best", factor.best},
                                       {"best_error", factor.best_error}});
        }
    if (sweep.of == SweepOf::atlas)
        for (const AtEqualError& pair : at_equal_error(sweep, atlas_project, atlas_gather, 0))
            out["fillings"].push_back({{"project", pair.slow->knobs},
                                       {"project_ms", pair.slow->milliseconds},
                                       {"project_error", pair.slow->error[0]},
                                       {"gather", pair.quick->knobs},
                                       {"gather_ms", pair.quick->milliseconds},
                                       {"gather_error", pair.quick->error[0]},
                                       {"factor", pair.factor}});
    for (const MathMode& mode : math_modes(sweep))
        out["math_modes"].push_back({{"math", mode.math},
                                     {"storage", mode.storage},
                                     {"ms", mode.milliseconds},
                                     {"speed", mode.speed},
                                     {"error", mode.error},
                                     {"difference", mode.difference}});
    out["points"] = nlohmann::ordered_json::array();
    for (const SweepPoint& point : sweep.points) {
        nlohmann::ordered_json row = {{"method", point.method},
                                      {"series", point.series},
                                      {"knobs", point.knobs},
                                      {"ms", point.milliseconds},
                                      {"energy_ratio", point.energy}};
        if (point.given_up) row["given_up"] = true;
        if (point.once_milliseconds) row["once_ms"] = *point.once_milliseconds;
        if (!point.estimated_error.empty()) row["estimated_error"] = point.estimated_error;
        for (std::size_t t = 0; t < sweep.truths.size(); ++t) {
            row["error"][sweep.truths[t].name] = point.error[t];
            row["front"][sweep.truths[t].name] = bool{point.front[t]};
        }
        out["points"].push_back(row);
    }
    return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

}  // namespace clgi::lab
