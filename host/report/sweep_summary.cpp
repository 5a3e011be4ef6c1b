// SPDX-License-Identifier: MIT
#include "report/sweep_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/pareto.hpp"
#include "report/relative_error.hpp"

namespace clgi::report {
namespace {

std::vector<const SweepPoint*> points_of(const Sweep& sweep, const std::string& series) {
    std::vector<const SweepPoint*> out;
    for (const SweepPoint& point : sweep.points)
        if (point.series == series) out.push_back(&point);
    return out;
}

std::vector<Cost> front_of(const Sweep& sweep, const std::string& method, int truth) {
    std::vector<Cost> out;
    for (const SweepPoint& point : sweep.points)
        // What noise explains alone has no time to compare.
        if (point.method == method && point.front[truth] && point.error[truth] > 0.0)
            out.push_back({point.milliseconds, point.error[truth]});
    std::sort(out.begin(), out.end(),
              [](const Cost& a, const Cost& b) { return a.milliseconds < b.milliseconds; });
    return out;
}

}  // namespace

Floor floor_of(const Sweep& sweep, const std::string& series, const std::string& knob, int truth) {
    const auto points = points_of(sweep, series);
    Floor out;
    if (points.empty()) return out;
    out.error = points.front()->error[truth];
    for (const SweepPoint* point : points) out.error = std::min(out.error, point->error[truth]);
    for (const SweepPoint* point : points) {
        if (point->error[truth] > 1.1 * out.error) continue;
        out.setting = point->knobs.at(knob);
        break;
    }
    return out;
}

Speedup speedup(const Sweep& sweep, const std::string& method, int truth) {
    Speedup out;
    out.method = method;
    const std::vector<Cost> front = front_of(sweep, method, truth);
    const std::vector<Cost> baseline = front_of(sweep, "path tracer", truth);
    if (!baseline.empty()) out.measured_to = baseline.back().error;
    for (const Cost& cost : front) {
        if (!(cost.error > 0.0)) continue;
        const auto time = time_to_reach(baseline, cost.error);
        if (!time) continue;
        const double factor = *time / cost.milliseconds;
        // The front ends at its least error.
        if (cost.error <= 1.1 * front.back().error && out.least_error == 0.0) {
            out.at_least_error = factor;
            out.least_error = cost.error;
        }
        if (factor > out.best) {
            out.best = factor;
            out.best_error = cost.error;
        }
    }
    return out;
}

std::vector<MathMode> math_modes(const Sweep& sweep) {
    std::vector<MathMode> out;
    const std::vector<const SweepPoint*> points = points_of(sweep, "math");
    for (const SweepPoint* point : points)
        out.push_back({point->knobs.at("math"), point->knobs.at("storage"), point->milliseconds,
                       points.front()->milliseconds / point->milliseconds,
                       point->error[one_bounce],
                       relative_error(point->picture, points.front()->picture)});
    return out;
}

std::vector<std::string> summary(const Sweep& sweep) {
    std::vector<std::string> out;
    const auto floor_line = [&](const char* series, const char* what, int truth) {
        const Floor floor = floor_of(sweep, series, "vpls", truth);
        if (!floor.setting.empty())
            out.push_back(fmt::format(
                "{}: from {} VPLs on, error against the {} reference stays at {:.2f} %.",
                what, floor.setting, truth_names[truth], 100.0 * floor.error));
    };
    floor_line("vpls, unshadowed", "Without negative VPLs", unshadowed_bounce);
    floor_line("vpls, unshadowed", "Without negative VPLs", all_light);
    floor_line("vpls", "With 150 negative VPLs", one_bounce);
    floor_line("vpls", "With 150 negative VPLs", all_light);

    const SweepPoint *none = nullptr, *best = nullptr;
    for (const SweepPoint* point : points_of(sweep, "negative-vpls")) {
        if (point->knobs.at("negative-vpls") == "0")
            none = point;
        else if (!best || point->error[all_light] < best->error[all_light])
            best = point;
    }
    if (none && best)
        out.push_back(fmt::format(
            "Negative VPLs: at {} VPLs the error against the full reference is "
            "{:.2f} % without and {:.2f} % with {} of them; against one bounce {:.2f} % and "
            "{:.2f} %.",
            none->knobs.at("vpls"), 100.0 * none->error[all_light], 100.0 * best->error[all_light],
            best->knobs.at("negative-vpls"), 100.0 * none->error[one_bounce],
            100.0 * best->error[one_bounce]));

    for (int t = 0; t < truths; ++t) {
        const Speedup factor = speedup(sweep, "second-order", t);
        const auto at = [&](double error) {
            return fmt::format("at {:.2f} %{}", 100.0 * error,
                               error < factor.measured_to ? ", extrapolated" : "");
        };
        if (factor.best > 0.0)
            out.push_back(fmt::format(
                "second-order against the path tracer, {} reference: {:.1f} times faster near the "
                "least error it reaches ({}), {:.1f} times {}.",
                truth_names[t], factor.at_least_error, at(factor.least_error), factor.best,
                at(factor.best_error)));
    }
    for (const MathMode& mode : math_modes(sweep))
        if (mode.difference > 0.0)
            out.push_back(fmt::format(
                "{} math, {} storage: {:.2f} times as fast as strict math on floats, pictures "
                "differ by {:.4f} %.",
                mode.math == "fast" ? "Fast" : "Strict", mode.storage, mode.speed,
                100.0 * mode.difference));

    for (int t = 0; t < truths; ++t)
        out.push_back(
            fmt::format("Standard error of the {} reference: {:.2f} %, taken out of all "
                        "errors.",
                        truth_names[t], 100.0 * sweep.truth_noise[t]));
    return out;
}

}  // namespace clgi::report
