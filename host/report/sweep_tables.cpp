// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "report/sweep_files.hpp"
#include "report/sweep_summary.hpp"

namespace clgi::report {
namespace {

std::string knob(const SweepPoint& point, const char* name) {
    const auto found = point.knobs.find(name);
    return found == point.knobs.end() ? "" : found->second;
}

constexpr const char* knobs[] = {"vpls",         "negative-vpls", "low-res", "shadow-size",
                                 "area-samples", "math",          "storage", "spp"};

}  // namespace

std::string sweep_csv(const Sweep& sweep) {
    std::string out = "method,series";
    for (const char* name : knobs) out += fmt::format(",{}", name);
    out += ",ms";
    for (const char* truth : truth_names) out += fmt::format(",error {0},front {0}", truth);
    out += ",energy ratio\n";
    for (const SweepPoint& point : sweep.points) {
        out += fmt::format("{},\"{}\"", point.method, point.series);
        for (const char* name : knobs) out += "," + knob(point, name);
        out += fmt::format(",{:.4g}", point.milliseconds);
        for (int t = 0; t < truths; ++t)
            out += fmt::format(",{:.6g},{}", point.error[t], point.front[t] ? 1 : 0);
        out += fmt::format(",{:.6g}\n", point.energy);
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
    for (int t = 0; t < truths; ++t)
        out["references"].push_back({{"name", truth_names[t]},
                                     {"effects", truth_effects[t]},
                                     {"standard_error", sweep.truth_noise[t]}});
    for (int t = 0; t < truths; ++t) {
        const Speedup factor = speedup(sweep, "second-order", t);
        out["speedups"].push_back({{"method", factor.method},
                                   {"reference", truth_names[t]},
                                   {"at_least_error", factor.at_least_error},
                                   {"least_error", factor.least_error},
                                   {"best", factor.best},
                                   {"best_error", factor.best_error}});
    }
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
        for (int t = 0; t < truths; ++t) {
            row["error"][truth_names[t]] = point.error[t];
            row["front"][truth_names[t]] = point.front[t];
        }
        out["points"].push_back(row);
    }
    return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

}  // namespace clgi::report
