// SPDX-License-Identifier: MIT
#include "lab/sweep_run.hpp"

#include <algorithm>
#include <clgi/error.hpp>

#include "lab/luminance.hpp"
#include "lab/pareto.hpp"
#include "lab/relative_error.hpp"

namespace clgi::lab {
namespace {

double sum_of_luminance(const io::Image& picture, const Mask* mask) {
    const std::vector<double> values = luminance_of(picture);
    double sum = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!mask || (*mask)[i]) sum += values[i];
    return sum;
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

void judge(SweepPoint& point, const std::vector<SweepTruth>& truths, const Mask* mask) {
    point.error.clear();
    for (const SweepTruth& truth : truths)
        point.error.push_back(relative_error(point.picture, truth.picture, mask));
    point.front.assign(truths.size(), false);
    point.energy =
        sum_of_luminance(point.picture, mask) / sum_of_luminance(truths.front().picture, mask);
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
