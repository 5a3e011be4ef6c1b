// SPDX-License-Identifier: MIT
#include "cli/ask.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/duration.hpp"
#include "cli/percent.hpp"

namespace clgi::cli {

using nlohmann::ordered_json;

void add_ask_flags(CLI::App& command, AskFlags& flags) {
    CLI::Option* error =
        command
            .add_option("--target-error", flags.target_error,
                        "Find the settings for this error: 2% or 0.02; auto: against all light, "
                        "second-order: against its converged picture")
            ->type_name("E")
            ->default_str("none");
    CLI::Option* time = command
                            .add_option("--time-budget", flags.time_budget,
                                        "Find the settings for this time: 33ms or 0.5s; auto: of a picture with "
                            "all before it, second-order: of a frame")
                            ->type_name("T")
                            ->default_str("none");
    for (const char* setting : {"--vpls", "--negative-vpls", "--low-res", "--low-res-step"})
        for (CLI::Option* asked : {error, time}) asked->excludes(command.get_option(setting));
}

report::Wish wish_of(const std::string& command, const AskFlags& flags) {
    report::Wish wish;
    if (!flags.target_error.empty())
        wish.target_error = parse_percent(command, "--target-error", flags.target_error);
    if (!flags.time_budget.empty())
        wish.budget_ms = parse_milliseconds(command, "--time-budget", flags.time_budget);
    return wish;
}

ordered_json ask_json(const AskRecord& record, double delivered_ms) {
    const report::Answer& answer = record.answer;
    ordered_json asked = ordered_json::object();
    if (record.wish.target_error) asked["target_error"] = *record.wish.target_error;
    if (record.wish.budget_ms) asked["time_budget_ms"] = *record.wish.budget_ms;
    const report::Settings& settings = answer.settings;
    ordered_json out = {{"asked", asked}, {"delivered_ms", delivered_ms}};
    if (answer.promised_ms) out["promised_ms"] = *answer.promised_ms;
    if (record.wish.budget_ms) out["budget_met"] = answer.budget_met;
    if (record.wish.target_error) {
        out["promised_error"] =
            answer.target_met ? ordered_json(*record.wish.target_error) : ordered_json();
        out["estimated_error"] = *answer.estimated_error;
        out["target_met"] = answer.target_met;
    }
    out["settings"] = {{"vpls", settings.lights},
                       {"negative_vpls", settings.negative_vpls},
                       {"low_res_step", settings.step}};
    // As --low-res takes it: JSON has no infinity, and a float's expansion has too many digits.
    ordered_json& low_res = out["settings"]["low_res"];
    if (settings.step == 1)
        low_res = "off";
    else if (std::isinf(settings.threshold))
        low_res = "inf";
    else
        low_res = std::stod(fmt::format("{}", settings.threshold));
    out["probe_ms"] = answer.probe_ms;
    return out;
}

std::string ask_line(const AskRecord& record, double delivered_ms) {
    const report::Answer& answer = record.answer;
    std::string line = "asked for";
    if (record.wish.target_error)
        line += fmt::format(" an error of {:.3g} %", 100.0 * *record.wish.target_error);
    if (record.wish.target_error && record.wish.budget_ms) line += " and";
    if (record.wish.budget_ms) line += fmt::format(" {:.4g} ms", *record.wish.budget_ms);
    line +=
        fmt::format(": promised {:.1f} ms, delivered {:.1f} ms", *answer.promised_ms, delivered_ms);
    if (answer.estimated_error)
        line += fmt::format(", estimated error {:.3g} %", 100.0 * *answer.estimated_error);
    const report::Settings& settings = answer.settings;
    return line + fmt::format(" (--vpls {} --negative-vpls {} {}; found in {:.1f} s)",
                              settings.lights, settings.negative_vpls,
                              settings.step == 1 ? "--low-res off"
                                                 : fmt::format("--low-res-step {} --low-res {}",
                                                               settings.step, settings.threshold),
                              1e-3 * answer.probe_ms);
}

std::string ask_warning(const AskRecord& record) {
    const report::Answer& answer = record.answer;
    std::string text;
    if (record.wish.target_error && !answer.target_met)
        text = fmt::format(
            "warning: the target error of {:.3g} % is not reached{}; the error is {:.3g} %",
            100.0 * *record.wish.target_error,
            record.wish.budget_ms ? " within the time budget" : "",
            100.0 * *answer.estimated_error);
    if (!record.wish.budget_ms) return text;
    const auto add = [&](const std::string& more) {
        text += text.empty() ? "warning: " + more : "; " + more;
    };
    if (!answer.budget_met)
        add(fmt::format("{} {:.1f} ms, more than the budget of {:.4g} ms",
                        answer.settings.lights == report::fewest_lights
                            ? "even the cheapest settings take"
                            : "times on this machine vary: the chosen settings took",
                        *answer.promised_ms, *record.wish.budget_ms));
    else if (answer.settings.lights == report::most_lights)
        add(fmt::format("the largest number of lights, {}, does not use up the budget",
                        report::most_lights));
    return text;
}

}  // namespace clgi::cli
