// SPDX-License-Identifier: MIT
#include "lab/sweep_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "lab/metrics.hpp"
#include "lab/sweep_atlas.hpp"
#include "lab/sweep_pictures.hpp"
#include "lab/sweep_transfer.hpp"

namespace clgi::lab {
namespace {

using Lines = std::vector<std::string>;
using Points = std::vector<const SweepPoint*>;
using Truths = std::vector<std::size_t>;

// What text_of says of each point: "1, 2, 3".
template <typename TextOf>
std::string list(const Points& points, const TextOf& text_of) {
    std::string out;
    for (const SweepPoint* point : points) out += (out.empty() ? "" : ", ") + text_of(*point);
    return out;
}

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

// Points of the series "bins" whose error was estimated.
Points estimated(const Sweep& sweep, std::size_t truth) {
    Points out = points_of(sweep, "bins");
    std::erase_if(out, [&](const SweepPoint* point) {
        return point->estimated_error.count(sweep.truths[truth].name) == 0;
    });
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
    const std::string knob = knob_of(series);
    std::string errors;
    for (const std::size_t t : truths)
        errors += fmt::format(
            "{}{} % ({})", errors.empty() ? "" : ", ",
            list(points,
                 [&](const SweepPoint& p) {
                     return p.given_up ? "diverged" : fmt::format("{:.2f}", 100.0 * p.error[t]);
                 }),
            sweep.truths[t].name);
    out.push_back(fmt::format(
        "{}, {} {}: error {} in {} ms.", points.front()->method, knob,
        list(points, [&](const SweepPoint& p) { return p.knobs.at(knob); }), errors,
        list(points, [](const SweepPoint& p) { return fmt::format("{:.1f}", p.milliseconds); })));
    if (points.front()->once_milliseconds)
        out.push_back(fmt::format("{} took {} ms.", once, list(points, [](const SweepPoint& p) {
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

std::vector<MathMode> math_modes(const Sweep& sweep) {
    std::vector<MathMode> out;
    const std::vector<const SweepPoint*> points = points_of(sweep, "math");
    for (const SweepPoint* point : points)
        out.push_back({point->knobs.at("math"), point->knobs.at("storage"), point->milliseconds,
                       points.front()->milliseconds / point->milliseconds, point->error[one_bounce],
                       relative_error(point->picture, points.front()->picture)});
    return out;
}

std::vector<AtEqualError> at_equal_error(const Sweep& sweep, const std::string& slow,
                                         const std::string& quick, std::size_t truth) {
    std::vector<AtEqualError> out;
    for (const SweepPoint& point : sweep.points) {
        if (point.method != slow || !point.front[truth]) continue;
        AtEqualError found{&point, nullptr, 0.0};
        for (const SweepPoint& other : sweep.points)
            if (other.method == quick && other.error[truth] <= point.error[truth] &&
                (!found.quick || other.milliseconds < found.quick->milliseconds))
                found.quick = &other;
        if (!found.quick) continue;
        found.factor = point.milliseconds / found.quick->milliseconds;
        out.push_back(found);
    }
    std::sort(out.begin(), out.end(), [](const AtEqualError& a, const AtEqualError& b) {
        return a.slow->milliseconds < b.slow->milliseconds;
    });
    return out;
}

EstimateQuality estimate_quality(const Sweep& sweep, std::size_t truth) {
    EstimateQuality out;
    for (const SweepPoint* point : estimated(sweep, truth)) {
        if (!(point->error[truth] > 0.0)) continue;  // what noise explains alone
        const double ratio =
            point->estimated_error.at(sweep.truths[truth].name) / point->error[truth];
        out.least = out.most == 0.0 ? ratio : std::min(out.least, ratio);
        out.most = std::max(out.most, ratio);
    }
    return out;
}

// ---- sentences ----------------------------------------------------------------------------------

namespace {

// For every truth that the method is an answer to and has a factor for.
void add_speedups(const Sweep& sweep, const std::string& method, const Truths& truths, Lines& out) {
    for (const std::size_t t : truths) {
        const Speedup factor = speedup(sweep, method, t);
        const auto at = [&](double error) {
            return fmt::format("at {:.2f} %{}", 100.0 * error,
                               error < factor.measured_to ? ", extrapolated" : "");
        };
        if (factor.best > 0.0)
            out.push_back(
                fmt::format("{} against the path tracer, {} reference: {:.1f} times faster near "
                            "the least error it reaches ({}), {:.1f} times {}.",
                            method, sweep.truths[t].name, factor.at_least_error,
                            at(factor.least_error), factor.best, at(factor.best_error)));
    }
}

// format: a sentence with the least and the greatest factor, and the number of pairs.
void add_equal_errors(const std::vector<AtEqualError>& pairs, const char* format, Lines& out) {
    if (pairs.empty()) return;
    const auto [least, most] = std::minmax_element(
        pairs.begin(), pairs.end(),
        [](const AtEqualError& a, const AtEqualError& b) { return a.factor < b.factor; });
    out.push_back(fmt::format(fmt::runtime(format), least->factor, most->factor, pairs.size()));
}

// What the error of antiradiance is estimated to be.
void add_estimates(const Sweep& sweep, std::size_t truth, Lines& out) {
    const Points points = estimated(sweep, truth);
    if (points.empty()) return;
    const std::string& name = sweep.truths[truth].name;
    const EstimateQuality quality = estimate_quality(sweep, truth);
    out.push_back(fmt::format(
        "Error against the {} reference as estimated from twice as many bins: {} % at {} bins, "
        "{:.2f} to {:.2f} times the true one.",
        name,
        list(points,
             [&](const SweepPoint& p) {
                 return fmt::format("{:.2f}", 100.0 * p.estimated_error.at(name));
             }),
        list(points, [](const SweepPoint& p) { return p.knobs.at("bins"); }), quality.least,
        quality.most));
}

void add_second_order(const Sweep& sweep, const Truths& all, Lines& out) {
    const auto floor_line = [&](const char* series, const char* what, std::size_t truth) {
        const Floor floor = floor_of(sweep, series, "vpls", truth);
        if (!floor.setting.empty())
            out.push_back(fmt::format(
                "{}: from {} VPLs on, error against the {} reference stays at {:.2f} %.", what,
                floor.setting, sweep.truths[truth].name, 100.0 * floor.error));
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

    add_speedups(sweep, second_order_method, all, out);
    for (const MathMode& mode : math_modes(sweep))
        if (mode.difference > 0.0)
            out.push_back(fmt::format(
                "{} math, {} storage: {:.2f} times as fast as strict math on floats, pictures "
                "differ by {:.4f} %.",
                mode.math == "fast" ? "Fast" : "Strict", mode.storage, mode.speed,
                100.0 * mode.difference));
}

void add_pictures(const Sweep& sweep, const Truths& all, Lines& out) {
    add_second_order(sweep, all, out);
    Truths links;  // that antiradiance is an answer to
    for (const std::size_t t : all)
        if (sweep.truths[t].name == full_truth || sweep.truths[t].name == indirect_truth)
            links.push_back(t);
    for (const char* series :
         {"bins", "elements", "iteration", "steps", "spread", "bin-share", "storage"})
        add_series(sweep, series, links, "Elements and links, once before all frames,", out);
    for (const std::size_t truth : links) add_estimates(sweep, truth, out);
    add_speedups(sweep, antiradiance_method, links, out);
    for (const char* series : {"vpls, atlas", "atlas-size, atlas"})
        add_series(sweep, series, {all_light}, "Laying out and baking, once before all frames,",
                   out);
    for (const char* series : {"mask, transfer", "interreflections, transfer"})
        add_series(sweep, series, {all_light}, "Transfer vectors, once before all frames,", out);
    for (const char* method : {light_atlas_method, dynamic_transfer_method})
        add_speedups(sweep, method, {all_light}, out);
}

void add_atlas(const Sweep& sweep, const Truths& all, Lines& out) {
    for (const char* series :
         {"vpls", "bounces", "samples-per-vpl", "exchange-samples", "hemicube-size",
          "vpls, project", "hemicube-size, project", "mesh", "kernel"}) {
        const Points points = points_of(sweep, series);
        if (points.empty()) continue;
        const std::string knob = knob_of(series);
        out.push_back(fmt::format(
            "{}{}, {} {}: error {} % in {} s.", points.front()->method,
            knob == "vpls" ? "" : fmt::format(" at {} VPLs", points.front()->knobs.at("vpls")),
            knob, list(points, [&](const SweepPoint& p) { return p.knobs.at(knob); }),
            list(points,
                 [](const SweepPoint& p) { return fmt::format("{:.1f}", 100.0 * p.error[0]); }),
            list(points, [](const SweepPoint& p) {
                return fmt::format("{:.2f}", 1e-3 * p.milliseconds);
            })));
    }
    add_equal_errors(at_equal_error(sweep, atlas_project, atlas_gather, 0),
                     "Fillings at equal error: gathering takes {:.1f} to {:.1f} times less time "
                     "than the {} settings on the front of projection.",
                     out);
    for (const char* method : {atlas_gather, atlas_project}) add_speedups(sweep, method, all, out);
}

void add_transfer(const Sweep& sweep, const Truths& all, Lines& out) {
    for (const char* series :
         {"mask", "mask-block", "cells", "table", "sh-order", "coarse", "rings", "looks"})
        add_series(sweep, series, all, "Finding the visible sets, once before all frames,", out);
    add_equal_errors(at_equal_error(sweep, transfer_fine, transfer_levels, smooth_environment),
                     "Two levels at equal error (smooth): {:.1f} to {:.1f} times less time than "
                     "settings on the front without them, {} of which they reach.",
                     out);
    for (const char* method : {transfer_fine, transfer_levels, transfer_sets})
        add_speedups(sweep, method, all, out);
}

}  // namespace

std::vector<std::string> summary(const Sweep& sweep) {
    Lines out;
    Truths all(sweep.truths.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    const auto add = sweep.of == SweepOf::atlas      ? add_atlas
                     : sweep.of == SweepOf::vertices ? add_transfer
                                                     : add_pictures;
    add(sweep, all, out);
    for (const SweepTruth& truth : sweep.truths)
        out.push_back(
            fmt::format("Standard error of the {} reference: {:.2f} %, taken out of all errors.",
                        truth.name, 100.0 * truth.noise));
    return out;
}

}  // namespace clgi::lab
