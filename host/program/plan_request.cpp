// SPDX-License-Identifier: MIT
#include "program/plan_request.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <clgi/error.hpp>

#include "program/percent.hpp"

namespace clgi::program {
namespace {

std::string all_names() {
    std::string out;
    for (std::size_t k = 0; k < effect_count; ++k)
        out += std::string(k > 0 ? ", " : "") + name_of(static_cast<Effect>(k));
    return out;
}

struct Effects {
    std::vector<Effect> named;
    bool all = false;
};

Effects effects_of(const std::string& command, const char* flag,
                   const std::vector<std::string>& names) {
    Effects out;
    for (const std::string& name : names) {
        if (name == "all") {
            out.all = true;
            continue;
        }
        const std::optional<Effect> effect = effect_of(name);
        if (!effect)
            throw Error(fmt::format("{}: {} is '{}'; effects are {} and all", command, flag, name,
                                    all_names()));
        out.named.push_back(*effect);
    }
    return out;
}

// "all" are those that the other flag does not name.
void add_rest(std::vector<Effect>& effects, const std::vector<Effect>& others) {
    const auto has = [](const std::vector<Effect>& list, Effect effect) {
        return std::find(list.begin(), list.end(), effect) != list.end();
    };
    for (std::size_t k = 0; k < effect_count; ++k) {
        const auto effect = static_cast<Effect>(k);
        if (!has(effects, effect) && !has(others, effect)) effects.push_back(effect);
    }
}

}  // namespace

void add_plan_flags(CLI::App& command, PlanFlags& flags) {
    command
        .add_option(
            "--tolerance", flags.tolerance,
            "auto: Effects are left out that change the picture by at most this: 1% or 0.01")
        ->type_name("E");
    command
        .add_option("--with", flags.with,
                    "auto: Effects that are on whatever the scene calls for, with commas; all")
        ->type_name("EFFECT")
        ->delimiter(',')
        ->default_str("none");
    command.add_option("--without", flags.without, "auto: Effects that are off, with commas")
        ->type_name("EFFECT")
        ->delimiter(',')
        ->default_str("none");
}

PlanRequest request_of(const std::string& command, const PlanFlags& flags) {
    PlanRequest out;
    out.tolerance = parse_percent(command, "--tolerance", flags.tolerance);
    const Effects with = effects_of(command, "--with", flags.with);
    const Effects without = effects_of(command, "--without", flags.without);
    out.with = with.named;
    out.without = without.named;
    if (with.all) add_rest(out.with, without.named);
    if (without.all) add_rest(out.without, with.named);
    return out;
}

}  // namespace clgi::program
