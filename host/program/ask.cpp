// SPDX-License-Identifier: MIT
#include "program/ask.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "program/duration.hpp"
#include "program/percent.hpp"

namespace clgi::program {

using nlohmann::ordered_json;

void add_ask_flags(CLI::App& command, AskFlags& flags) {
    CLI::Option* error =
        command
            .add_option("--target-error", flags.target_error,
                        "Find the settings for this error: 2% or 0.02; auto: against all light, "
                        "second-order: against its converged picture")
            ->type_name("E")
            ->default_str("none");
    CLI::Option* budget =
        command
            .add_option("--time-budget", flags.time_budget,
                        "Find the settings with which a picture and all before it take this time: "
                        "0.5s; as clgi plan")
            ->type_name("T")
            ->default_str("none");
    CLI::Option* frame =
        command
            .add_option("--frame-time", flags.frame_time,
                        "Find the settings for frames of this time: 33ms; with --fps by a plan, "
                        "otherwise second-order by trial pictures")
            ->type_name("T")
            ->default_str("none")
            ->excludes(budget);
    for (const char* setting : {"--vpls", "--negative-vpls", "--low-res", "--low-res-step"})
        for (CLI::Option* asked : {error, budget, frame})
            asked->excludes(command.get_option(setting));
}

TuningTarget request_of(const std::string& command, const AskFlags& flags) {
    TuningTarget request;
    if (!flags.target_error.empty())
        request.error = parse_percent(command, "--target-error", flags.target_error);
    if (!flags.frame_time.empty())
        request.frame_ms = parse_milliseconds(command, "--frame-time", flags.frame_time);
    return request;
}

ordered_json ask_json(const AskRecord& record, double delivered_ms) {
    const SecondOrderTuning& found = record.tuning;
    ordered_json asked = ordered_json::object();
    if (record.request.error) asked["target_error"] = *record.request.error;
    if (record.request.frame_ms) asked["frame_time_ms"] = *record.request.frame_ms;
    const SecondOrderSettings& settings = found.settings;
    ordered_json out = {{"asked", asked}, {"delivered_ms", delivered_ms}};
    out["promised_ms"] = found.frame_ms;
    if (record.request.frame_ms) out["budget_met"] = found.meets_time;
    if (record.request.error) {
        out["promised_error"] =
            found.meets_error ? ordered_json(*record.request.error) : ordered_json();
        out["estimated_error"] = *found.error;
        out["target_met"] = found.meets_error;
    }
    out["settings"] = {{"vpls", settings.vpls},
                       {"negative_vpls", settings.negative_vpls},
                       {"low_res_step", settings.low_resolution_step}};
    // As --low-res takes it: JSON has no infinity, and a float's expansion has too many digits.
    ordered_json& low_res = out["settings"]["low_res"];
    if (settings.low_resolution_step == 1)
        low_res = "off";
    else if (std::isinf(settings.discontinuity_threshold))
        low_res = "inf";
    else
        low_res = std::stod(fmt::format("{}", settings.discontinuity_threshold));
    out["probe_ms"] = found.milliseconds;
    return out;
}

std::string ask_line(const AskRecord& record, double delivered_ms) {
    const SecondOrderTuning& found = record.tuning;
    std::string line = "asked for";
    if (record.request.error)
        line += fmt::format(" an error of {:.3g} %", 100.0 * *record.request.error);
    if (record.request.error && record.request.frame_ms) line += " and";
    if (record.request.frame_ms) line += fmt::format(" {:.4g} ms", *record.request.frame_ms);
    line += fmt::format(": promised {:.1f} ms, delivered {:.1f} ms", found.frame_ms, delivered_ms);
    if (found.error) line += fmt::format(", estimated error {:.3g} %", 100.0 * *found.error);
    const SecondOrderSettings& settings = found.settings;
    return line + fmt::format(" (--vpls {} --negative-vpls {} {}; found in {:.1f} s)",
                              settings.vpls, settings.negative_vpls,
                              settings.low_resolution_step == 1
                                  ? "--low-res off"
                                  : fmt::format("--low-res-step {} --low-res {}",
                                                settings.low_resolution_step,
                                                settings.discontinuity_threshold),
                              1e-3 * found.milliseconds);
}

std::string ask_warning(const AskRecord& record) {
    const SecondOrderTuning& found = record.tuning;
    std::string text;
    if (record.request.error && !found.meets_error)
        text = fmt::format(
            "warning: the target error of {:.3g} % is not reached{}; the error is {:.3g} %",
            100.0 * *record.request.error, record.request.frame_ms ? " within the frame time" : "",
            100.0 * *found.error);
    if (!record.request.frame_ms) return text;
    const auto add = [&](const std::string& more) {
        text += text.empty() ? "warning: " + more : "; " + more;
    };
    if (!found.meets_time)
        add(fmt::format("{} {:.1f} ms, more than the frame time of {:.4g} ms",
                        found.settings.vpls == SecondOrderTuning::fewest_vpls
                            ? "even the cheapest settings take"
                            : "times on this machine vary: the chosen settings took",
                        found.frame_ms, *record.request.frame_ms));
    else if (found.settings.vpls == SecondOrderTuning::most_vpls)
        add(fmt::format("the largest number of lights, {}, does not use up the frame time",
                        SecondOrderTuning::most_vpls));
    return text;
}

}  // namespace clgi::program
