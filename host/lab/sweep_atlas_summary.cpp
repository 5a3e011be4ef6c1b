// What a sweep of the light atlas says.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "lab/sweep_atlas.hpp"
#include "lab/sweep_summary.hpp"

namespace clgi::lab {
namespace {

std::string list(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
    return out;
}

void add_series(const Sweep& sweep, const std::string& series, std::vector<std::string>& out) {
    const auto points = points_of(sweep, series);
    if (points.empty()) return;
    const std::string knob = knob_of(series);
    std::vector<std::string> values, errors, times;
    for (const SweepPoint* point : points) {
        values.push_back(point->knobs.at(knob));
        errors.push_back(fmt::format("{:.1f}", 100.0 * point->error[0]));
        times.push_back(fmt::format("{:.2f}", 1e-3 * point->milliseconds));
    }
    const std::string vpls =
        knob == "vpls" ? "" : fmt::format(" at {} VPLs", points.front()->knobs.at("vpls"));
    out.push_back(fmt::format("{}{}, {} {}: error {} % in {} s.", points.front()->method, vpls,
                              knob, list(values), list(errors), list(times)));
}

}  // namespace

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

std::vector<std::string> atlas_summary(const Sweep& sweep) {
    std::vector<std::string> out;
    for (const char* series :
         {"vpls", "bounces", "samples-per-vpl", "exchange-samples", "hemicube-size",
          "vpls, project", "hemicube-size, project", "mesh", "kernel"})
        add_series(sweep, series, out);
    const std::vector<AtEqualError> fillings =
        at_equal_error(sweep, atlas_project, atlas_gather, 0);
    if (!fillings.empty()) {
        const auto [least, most] = std::minmax_element(
            fillings.begin(), fillings.end(),
            [](const AtEqualError& a, const AtEqualError& b) { return a.factor < b.factor; });
        out.push_back(fmt::format(
            "Fillings at equal error: gathering takes {:.1f} to {:.1f} times less time than the {} "
            "settings on the front of projection.",
            least->factor, most->factor, fillings.size()));
    }
    add_speedups(sweep, atlas_gather, out);
    add_speedups(sweep, atlas_project, out);
    return out;
}

}  // namespace clgi::lab
