// SPDX-License-Identifier: MIT
#include "scene/median_cut.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/luminance.hpp"
#include "scene/sky_cells.hpp"

namespace clgi {
namespace {

using Patch = SkyCells::Patch;
using std::numbers::pi;

// Both halves of a patch, as equal in power as whole cells allow.
std::pair<Patch, Patch> cut(const SkyCells& cells, const Patch& patch) {
    const double high = pi * (patch.bottom - patch.top) / cells.height();
    const double wide = 2.0 * pi * (patch.right - patch.left) / cells.width() *
                        std::sin(pi * 0.5 * (patch.top + patch.bottom) / cells.height());
    const bool by_rows =
        patch.right - patch.left == 1 || (high > wide && patch.bottom - patch.top > 1);
    const auto first = [&](int place) {
        return by_rows ? cells.patch(patch.top, place, patch.left, patch.right)
                       : cells.patch(patch.top, patch.bottom, patch.left, place);
    };
    int best = by_rows ? patch.top + 1 : patch.left + 1;
    const int end = by_rows ? patch.bottom : patch.right;
    double least = std::abs(first(best).power - 0.5 * patch.power);
    for (int place = best + 1; place < end; ++place) {
        const double off = std::abs(first(place).power - 0.5 * patch.power);
        if (off < least) {
            least = off;
            best = place;
        }
    }
    return {first(best), by_rows ? cells.patch(best, patch.bottom, patch.left, patch.right)
                                 : cells.patch(patch.top, patch.bottom, best, patch.right)};
}

}  // namespace

std::vector<SkyLight> median_cut(const Environment& environment, int count) {
    std::vector<SkyLight> lights;
    if (count < 1) return lights;
    const SkyCells cells(environment);
    std::vector<Patch> patches = {cells.patch(0, cells.height(), 0, cells.width())};
    const double nothing = 1e-14 * patches[0].power;  // less than sums of doubles can tell
    while (patches.size() < static_cast<std::size_t>(count)) {
        const auto strongest =
            std::max_element(patches.begin(), patches.end(), [](const Patch& a, const Patch& b) {
                return (a.whole() ? 0.0 : a.power) < (b.whole() ? 0.0 : b.power);
            });
        if (strongest->whole() || !(strongest->power > 0.0)) break;
        auto [first, second] = cut(cells, *strongest);
        if (!(first.power > nothing)) std::swap(first, second);
        *strongest = first;
        if (second.power > nothing) patches.push_back(second);
    }
    for (const Patch& patch : patches) {
        const SkyLight light = cells.light_of(patch);
        if (luminance(light.lux) > 0.0) lights.push_back(light);
    }
    return lights;
}

}  // namespace clgi
