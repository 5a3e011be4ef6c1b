// SPDX-License-Identifier: MIT
#include "program/verify.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "program/duration.hpp"
#include "program/session.hpp"
#include "program/stopwatch.hpp"

namespace clgi::program {
namespace {

using nlohmann::ordered_json;
using reference::CheckedPixel;
using reference::Estimate;
using reference::Verification;

constexpr double default_share = 0.1;     // of the time before
constexpr double default_seconds = 0.05;  // at least
const std::string none = "none";

std::string percent(double share) {
    return share < 10.0 ? fmt::format("{:.3g}", 100.0 * share)
                        : fmt::format("{:.0f}", 100.0 * share);
}

// JSON has no infinity: null.
ordered_json interval_json(const Estimate& found) {
    const auto number = [](double value) {
        return std::isfinite(value) ? ordered_json(value) : ordered_json();
    };
    return {
        {"value", number(found.value)}, {"low", number(found.low)}, {"high", number(found.high)}};
}

}  // namespace

void add_verify_flag(CLI::App& command, VerifyFlags& flags, const std::string& what) {
    command
        .add_option_function<std::string>(
            "--verify",
            [&flags](const std::string& time) {
                flags.on = true;
                if (time != none) flags.time = time;
            },
            "Measure the error of the " + what +
                " by path-tracing some hundred of its parts, in this time; without TIME a tenth of "
                "the time before")
        ->type_name("TIME")
        ->expected(0, 1)
        ->default_str(none);  // and what CLI11 hands over for a flag without a value
}

void check_verify(const std::string& command, const VerifyFlags& flags) {
    if (!flags.time.empty()) parse_milliseconds(command, "--verify", flags.time);
}

std::optional<Verification> verify(const Scene& scene, const VerifyFlags& flags, double spent,
                                   const Check& check) {
    const Stopwatch watch;
    const double seconds = flags.time.empty()
                               ? std::max(default_share * spent, default_seconds)
                               : 1e-3 * parse_milliseconds("", "--verify", flags.time);
    try {
        const reference::PathTracer tracer(scene);
        reference::VerifyOptions options;
        options.samples = 1 << 20;  // time is the limit
        options.seconds = std::max(seconds - watch.seconds(), 1e-3);
        Verification found = check(tracer, options);
        if (found.cancelled) return std::nullopt;
        found.seconds = watch.seconds();
        if (found.non_finite > 0)
            notice(false, fmt::format("warning: --verify: {} samples were not finite and were left "
                                      "out",
                                      found.non_finite));
        return found;
    } catch (const Error& error) {
        notice(false, fmt::format("warning: --verify: not checked: {}", error.what()));
        return std::nullopt;
    }
}

std::string verify_line(const Verification& found) {
    const Estimate &error = found.error, &energy = found.energy;
    const auto end = [](double value, const std::string& text) {
        return std::isfinite(value) ? " to " + text : " or more";
    };
    return fmt::format("measured error {} % ({}{}), energy {:.3f} ({:.3f}{})", percent(error.value),
                       percent(error.low), end(error.high, percent(error.high)), energy.value,
                       energy.low, end(energy.high, fmt::format("{:.3f}", energy.high)));
}

std::string expected_less(std::optional<double> expected, const Verification& found) {
    if (!expected || *expected >= found.error.low) return "";
    return fmt::format("the plan expected an error of {} %, measured {} %", percent(*expected),
                       percent(found.error.value));
}

ordered_json verify_json(const Verification& found) {
    ordered_json out = interval_json(found.error);
    out["energy"] = interval_json(found.energy);
    out["pixels"] = found.pixels;
    out["samples"] = found.samples;
    out["non_finite"] = found.non_finite;
    out["seconds"] = found.seconds;
    return out;
}

std::string largest_lines(const Verification& found) {
    std::string out;
    if (!(found.error.low > 0.0)) return out;  // noise
    for (const CheckedPixel& one : found.largest)
        if (one.share >= 0.1)
            out += fmt::format(
                "  {} % of the squared error at {},{}: {:.3g}, traced {:.3g} +- "
                "{:.2g} cd/m^2\n",
                percent(one.share), one.column, one.row, one.picture, one.truth, one.deviation);
    return out;
}

ordered_json picture_json(const Verification& found) {
    ordered_json out = verify_json(found);
    out["largest"] = ordered_json::array();
    for (const CheckedPixel& one : found.largest)
        out["largest"].push_back({{"pixel", {one.column, one.row}},
                                  {"share", one.share},
                                  {"picture", one.picture},
                                  {"truth", one.truth},
                                  {"deviation", one.deviation}});
    return out;
}

void add_filter_flag(CLI::App& command, std::string& filter) {
    command
        .add_option("--filter", filter,
                    "What of a pixel is looked through: its centre, or all of it (box)")
        ->type_name("WHAT")
        ->check(CLI::IsMember({"center", "box"}));
}

reference::Filter filter_of(const std::string& name) {
    return name == "box" ? reference::Filter::box : reference::Filter::center;
}

void add_verified(io::Image& picture, const Verification& found) {
    const auto add = [&](const std::string& name, const Estimate& estimate) {
        picture.attributes[name] = fmt::format("{:.6g}", estimate.value);
        picture.attributes[name + "_low"] = fmt::format("{:.6g}", estimate.low);
        picture.attributes[name + "_high"] = fmt::format("{:.6g}", estimate.high);
    };
    add("clgi:measured_error", found.error);
    add("clgi:measured_energy", found.energy);
}

}  // namespace clgi::program
