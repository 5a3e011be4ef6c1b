// What a sweep of antiradiance says.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "lab/picture_methods.hpp"
#include "lab/sweep_antiradiance.hpp"
#include "lab/sweep_summary.hpp"

namespace clgi::lab {
namespace {

// Points of the series "bins" whose error was estimated.
std::vector<const SweepPoint*> estimated(const Sweep& sweep, std::size_t truth) {
    std::vector<const SweepPoint*> out;
    for (const SweepPoint* point : points_of(sweep, "bins"))
        if (point->estimated_error.count(sweep.truths[truth].name) > 0) out.push_back(point);
    return out;
}

void add_estimates(const Sweep& sweep, std::size_t truth, std::vector<std::string>& out) {
    const auto points = estimated(sweep, truth);
    if (points.empty()) return;
    const std::string& name = sweep.truths[truth].name;
    const auto list = [&](const auto& text_of) {
        std::string text;
        for (const SweepPoint* point : points) text += (text.empty() ? "" : ", ") + text_of(*point);
        return text;
    };
    const EstimateQuality quality = estimate_quality(sweep, truth);
    out.push_back(fmt::format(
        "Error against the {} reference as estimated from twice as many bins: {} % at {} bins, "
        "{:.2f} to {:.2f} times the true one.",
        name, list([&](const SweepPoint& p) {
            return fmt::format("{:.2f}", 100.0 * p.estimated_error.at(name));
        }),
        list([](const SweepPoint& p) { return p.knobs.at("bins"); }), quality.least, quality.most));
}

}  // namespace

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

std::vector<std::string> antiradiance_summary(const Sweep& sweep) {
    std::vector<std::string> out;
    std::vector<std::size_t> truths;  // that it is an answer to
    for (std::size_t t = 0; t < sweep.truths.size(); ++t)
        if (sweep.truths[t].name == full_truth || sweep.truths[t].name == indirect_truth)
            truths.push_back(t);
    for (const char* series :
         {"bins", "elements", "iteration", "steps", "spread", "bin-share", "storage"})
        add_series(sweep, series, truths, "Elements and links, once before all frames,", out);
    for (const std::size_t truth : truths) add_estimates(sweep, truth, out);
    add_speedups(sweep, antiradiance_method, truths, out);
    return out;
}

}  // namespace clgi::lab
