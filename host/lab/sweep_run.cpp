// SPDX-License-Identifier: MIT
#include "lab/sweep_run.hpp"

#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "lab/metrics.hpp"
#include "lab/reference_picture.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

// For each setting the first that is the same.
std::vector<std::size_t> first_of_each(const std::vector<SweepSetting>& settings,
                                       const Turns& turns) {
    const auto same = [&](std::size_t a, std::size_t b) {
        return turns.same ? turns.same(a, b)
                          : settings[a].method == settings[b].method &&
                                settings[a].knobs == settings[b].knobs;
    };
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        std::size_t k = 0;
        while (k < i && !(out[k] == k && same(k, i))) ++k;
        out.push_back(k);
    }
    return out;
}

}  // namespace

void SweepProgress::part(double from, double span) {
    from_ = from;
    span_ = span;
    report(0.0);
}

bool SweepProgress::goes_on(double share) const {
    return !progress_ || progress_(from_ + span_ * std::clamp(share, 0.0, 1.0));
}

void SweepProgress::report(double share) const {
    if (!goes_on(share)) throw_cancelled();
}

void throw_cancelled() { throw Error("sweep: cancelled"); }

std::vector<SweepPoint> measure_in_turn(const std::vector<SweepSetting>& settings,
                                        const Turns& turns, const SweepProgress& progress,
                                        std::size_t& non_finite) {
    const std::vector<std::size_t> first = first_of_each(settings, turns);
    const auto work = [&](std::size_t i) { return turns.work ? turns.work(i) : 1.0; };
    double all = 0.0, done = 0.0;
    for (std::size_t i = 0; i < settings.size(); ++i)
        if (first[i] == i) all += turns.rounds * work(i);
    std::vector<SweepPoint> results(settings.size());
    std::vector<std::vector<double>> times(settings.size()), once(settings.size());
    std::vector<std::uint8_t> again(settings.size(), 1);
    for (int round = 0; round < turns.rounds; ++round)
        for (std::size_t i = 0; i < settings.size(); ++i) {
            if (first[i] != i) continue;
            const double share = work(i) / all;
            progress.report(done);
            if (again[i]) {
                const Measured found = turns.measure(
                    i, round == 0 ? &results[i] : nullptr,
                    [&](double part) { return progress.goes_on(done + share * part); });
                progress.report(done);
                times[i].insert(times[i].end(), found.milliseconds.begin(),
                                found.milliseconds.end());
                if (found.once) once[i].push_back(*found.once);
                again[i] = found.again ? 1 : 0;
                if (round == 0) non_finite += found.non_finite;
            }
            done += share;
        }
    std::vector<SweepPoint> out;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        SweepPoint point = results[first[i]];
        static_cast<SweepSetting&>(point) = settings[i];
        point.milliseconds = spread(times[first[i]]).median;
        if (!once[first[i]].empty()) point.once_milliseconds = spread(once[first[i]]).median;
        out.push_back(std::move(point));
    }
    return out;
}

void add_truth(Sweep& sweep, const std::string& name, const std::string& effects,
               io::Image picture) {
    if (picture.channels.empty()) throw_cancelled();
    const double noise = stated_error(picture);
    sweep.truths.push_back({name, effects, std::move(picture), noise});
}

void judge(SweepPoint& point, const std::vector<SweepTruth>& truths, const Mask* mask) {
    point.error.clear();
    for (const SweepTruth& truth : truths)
        point.error.push_back(relative_error(point.picture, truth.picture, mask));
    point.front.assign(truths.size(), false);
    point.energy = luminance_ratio(point.picture, truths.front().picture, mask);
}

Sweep sweep_of(SweepOf of, const SweepSetup& setup) {
    Sweep out;
    out.of = of;
    out.scene = setup.scene.name;
    out.device = describe(setup.queue.getInfo<CL_QUEUE_DEVICE>());
    out.triangles = setup.scene.triangles.size();
    return out;
}

reference::Options tracing(const std::string& effects, int samples, std::uint64_t seed) {
    reference::Options out;
    out.effects = reference::parse_effects(effects);
    out.samples = samples;
    out.seed = seed;
    return out;
}

void add_traced(Sweep& sweep, const std::string& truth, int samples, double seconds,
                io::Image picture, const Mask* mask) {
    SweepPoint point;
    point.method = path_tracer_name;
    point.series = truth;
    point.knobs = {{"spp", std::to_string(samples)}};
    point.milliseconds = 1e3 * seconds;
    point.picture = std::move(picture);
    judge(point, sweep.truths, mask);
    sweep.points.push_back(std::move(point));
}

void trace_irradiance(Sweep& sweep, const SweepSetup& setup, const SweepTruth& truth,
                      const reference::PathTracer& tracer,
                      const std::vector<reference::Place>& places,
                      const std::function<io::Image(const reference::Irradiance&)>& image_of,
                      const Mask& counted, const SweepProgress& progress) {
    const int most = setup.quick ? 16 : 256;
    double done = 0.0;
    for (int samples = 1; samples <= most; samples *= 4) {
        const double share = 0.75 * samples / most;  // of a sum of powers of four
        const reference::Irradiance found =
            tracer.irradiance(places, tracing(truth.effects, samples, baseline_seed),
                              [&](double part) { return progress.goes_on(done + share * part); });
        if (found.cancelled) throw_cancelled();
        done += share;
        add_traced(sweep, truth.name, samples, found.seconds, image_of(found), &counted);
    }
}

std::vector<std::size_t> pareto_front(const std::vector<Cost>& points) {
    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        if (points[a].milliseconds != points[b].milliseconds)
            return points[a].milliseconds < points[b].milliseconds;
        return points[a].error < points[b].error;
    });
    std::vector<std::size_t> front;
    double least = std::numeric_limits<double>::infinity();
    for (const std::size_t index : order) {
        if (!(points[index].error < least)) continue;
        least = points[index].error;
        front.push_back(index);
    }
    return front;
}

std::optional<double> time_to_reach(const std::vector<Cost>& curve, double error) {
    if (curve.empty() || !(error > 0.0)) return std::nullopt;
    for (std::size_t i = 0; i < curve.size(); ++i) {
        if (curve[i].error > error) continue;
        if (i == 0) {  // before its first point, by the root of time as well
            const double ratio = curve[0].error / error;
            return curve[0].milliseconds * ratio * ratio;
        }
        const Cost &a = curve[i - 1], &b = curve[i];
        const double along = std::log(error / a.error) / std::log(b.error / a.error);
        return a.milliseconds * std::pow(b.milliseconds / a.milliseconds, along);
    }
    const double ratio = curve.back().error / error;
    return curve.back().milliseconds * ratio * ratio;
}

void mark_fronts(Sweep& sweep) {
    std::vector<std::string> methods = sweep.methods;
    methods.emplace_back(path_tracer_name);
    for (std::size_t t = 0; t < sweep.truths.size(); ++t)
        for (const std::string& method : methods) {
            std::vector<Cost> costs;
            std::vector<SweepPoint*> points;
            for (SweepPoint& point : sweep.points) {
                if (point.method != method || point.given_up) continue;
                if (method == path_tracer_name && point.series != sweep.truths[t].name) continue;
                costs.push_back({point.milliseconds, point.error[t]});
                points.push_back(&point);
            }
            for (const std::size_t i : pareto_front(costs)) points[i]->front[t] = true;
        }
}

}  // namespace clgi::lab
