// SPDX-License-Identifier: MIT
#include "lab/sweep_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lab/pareto.hpp"

namespace clgi::lab {
namespace {

std::vector<Cost> front_of(const Sweep& sweep, const std::string& method, std::size_t truth) {
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

std::vector<const SweepPoint*> points_of(const Sweep& sweep, const std::string& series) {
    std::vector<const SweepPoint*> out;
    for (const SweepPoint& point : sweep.points)
        if (point.series == series) out.push_back(&point);
    return out;
}

std::string knob_of(const std::string& series) { return series.substr(0, series.find(',')); }

void add_series(const Sweep& sweep, const std::string& series,
                const std::vector<std::size_t>& truths, const std::string& once,
                std::vector<std::string>& out) {
    const auto points = points_of(sweep, series);
    if (points.empty()) return;
    const auto list = [&](const auto& text_of) {
        std::string text;
        for (const SweepPoint* point : points) text += (text.empty() ? "" : ", ") + text_of(*point);
        return text;
    };
    const std::string knob = knob_of(series);
    std::string errors;
    for (const std::size_t t : truths)
        errors += fmt::format(
            "{}{} % ({})", errors.empty() ? "" : ", ", list([&](const SweepPoint& p) {
                return p.given_up ? "diverged" : fmt::format("{:.2f}", 100.0 * p.error[t]);
            }),
            sweep.truths[t].name);
    out.push_back(fmt::format(
        "{}, {} {}: error {} in {} ms.", points.front()->method, knob,
        list([&](const SweepPoint& p) { return p.knobs.at(knob); }), errors,
        list([](const SweepPoint& p) { return fmt::format("{:.1f}", p.milliseconds); })));
    if (points.front()->once_milliseconds)
        out.push_back(fmt::format("{} took {} ms.", once, list([](const SweepPoint& p) {
                                      const double time = p.once_milliseconds.value_or(0.0);
                                      return fmt::format("{:.{}f}", time, time < 10.0 ? 2 : 0);
                                  })));
}

Floor floor_of(const Sweep& sweep, const std::string& series, const std::string& knob,
               std::size_t truth) {
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

Speedup speedup(const Sweep& sweep, const std::string& method, std::size_t truth) {
    Speedup out;
    out.method = method;
    const std::vector<Cost> front = front_of(sweep, method, truth);
    const std::vector<Cost> baseline = front_of(sweep, path_tracer_name, truth);
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

void add_speedups(const Sweep& sweep, const std::string& method, std::vector<std::string>& out) {
    std::vector<std::size_t> all(sweep.truths.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    add_speedups(sweep, method, all, out);
}

void add_speedups(const Sweep& sweep, const std::string& method,
                  const std::vector<std::size_t>& truths, std::vector<std::string>& out) {
    for (const std::size_t t : truths) {
        const Speedup factor = speedup(sweep, method, t);
        const auto at = [&](double error) {
            return fmt::format("at {:.2f} %{}", 100.0 * error,
                               error < factor.measured_to ? ", extrapolated" : "");
        };
        if (factor.best > 0.0)
            out.push_back(
                fmt::format("{} against the path tracer, {} reference: {:.1f} times faster near "
                            "the least error "
                            "it reaches ({}), {:.1f} times {}.",
                            method, sweep.truths[t].name, factor.at_least_error,
                            at(factor.least_error), factor.best, at(factor.best_error)));
    }
}

std::vector<std::string> summary(const Sweep& sweep) {
    std::vector<std::string> out = sweep.of == SweepOf::atlas      ? atlas_summary(sweep)
                                   : sweep.of == SweepOf::vertices ? transfer_summary(sweep)
                                                                   : pictures_summary(sweep);
    for (const SweepTruth& truth : sweep.truths)
        out.push_back(
            fmt::format("Standard error of the {} reference: {:.2f} %, taken out of all errors.",
                        truth.name, 100.0 * truth.noise));
    return out;
}

}  // namespace clgi::lab
