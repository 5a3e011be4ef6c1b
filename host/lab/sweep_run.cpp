// SPDX-License-Identifier: MIT
#include "lab/sweep_run.hpp"

#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>

#include "lab/pareto.hpp"
#include "lab/relative_error.hpp"

namespace clgi::lab {

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
            tracer.irradiance(places, tracing(truth.effects, samples, 77),  // not the truth's seed
                              [&](double part) { return progress.goes_on(done + share * part); });
        if (found.cancelled) throw_cancelled();
        done += share;
        SweepPoint point;
        point.method = path_tracer_name;
        point.series = truth.name;
        point.knobs = {{"spp", std::to_string(samples)}};
        point.milliseconds = 1e3 * found.seconds;
        point.picture = image_of(found);
        judge(point, sweep.truths, &counted);
        sweep.points.push_back(std::move(point));
    }
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
