// What a sweep of dynamic transfer says.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "report/sweep_summary.hpp"
#include "report/sweep_transfer.hpp"

namespace clgi::report {
namespace {

void add_series(const Sweep& sweep, const std::string& series, std::vector<std::string>& out) {
    const auto points = points_of(sweep, series);
    if (points.empty()) return;
    const auto list = [&](const auto& text_of) {
        std::string text;
        for (const SweepPoint* point : points) text += (text.empty() ? "" : ", ") + text_of(*point);
        return text;
    };
    const auto error = [](std::size_t truth) {
        return
            [truth](const SweepPoint& p) { return fmt::format("{:.2f}", 100.0 * p.error[truth]); };
    };
    out.push_back(fmt::format(
        "{}, {} {}: error {} % (full), {} % (smooth) in {} ms.", points.front()->method, series,
        list([&](const SweepPoint& p) { return p.knobs.at(series); }),
        list(error(full_environment)), list(error(smooth_environment)),
        list([](const SweepPoint& p) { return fmt::format("{:.1f}", p.milliseconds); })));
    if (points.front()->look_milliseconds)
        out.push_back(fmt::format("Finding the visible sets, once before all frames, took {} ms.",
                                  list([](const SweepPoint& p) {
                                      return fmt::format("{:.0f}",
                                                         p.look_milliseconds.value_or(0.0));
                                  })));
}

}  // namespace

std::vector<std::string> transfer_summary(const Sweep& sweep) {
    std::vector<std::string> out;
    for (const char* series :
         {"mask", "mask-block", "cells", "table", "sh-order", "coarse", "rings", "looks"})
        add_series(sweep, series, out);
    const auto pairs = at_equal_error(sweep, transfer_fine, transfer_levels, smooth_environment);
    if (!pairs.empty()) {
        const auto [least, most] =
            std::minmax_element(pairs.begin(), pairs.end(),
                                [](const auto& a, const auto& b) { return a.factor < b.factor; });
        out.push_back(fmt::format(
            "Two levels at equal error (smooth): {:.1f} to {:.1f} times less time than settings on "
            "the front without them, {} of which they reach.",
            least->factor, most->factor, pairs.size()));
    }
    add_speedups(sweep, transfer_fine, out);
    add_speedups(sweep, transfer_levels, out);
    add_speedups(sweep, transfer_sets, out);
    return out;
}

}  // namespace clgi::report
