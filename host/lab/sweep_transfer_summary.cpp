// What a sweep of dynamic transfer says.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "lab/sweep_summary.hpp"
#include "lab/sweep_transfer.hpp"

namespace clgi::lab {
std::vector<std::string> transfer_summary(const Sweep& sweep) {
    std::vector<std::string> out;
    for (const char* series :
         {"mask", "mask-block", "cells", "table", "sh-order", "coarse", "rings", "looks"})
        add_series(sweep, series, {full_environment, smooth_environment},
                   "Finding the visible sets, once before all frames,", out);
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

}  // namespace clgi::lab
