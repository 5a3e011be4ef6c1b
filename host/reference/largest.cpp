// SPDX-License-Identifier: MIT
#include "reference/largest.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace clgi::reference {
namespace {

// The draws of a pixel. The mean over strata of means over draws is the squared error.
struct Sums {
    double square = 0.0;  // its part of the sum over strata
    double picture = 0.0;
    double samples = 0.0;
    double light = 0.0;     // of all samples
    double variance = 0.0;  // of that sum
};

}  // namespace

std::vector<CheckedPixel> largest_of(const std::vector<Traced>& pixels, std::size_t width,
                                     std::size_t most) {
    std::map<std::size_t, double> draws;  // of a stratum
    for (const Traced& one : pixels) draws[one.drawn.stratum] += 1.0;
    std::map<std::size_t, Sums> all;
    double total = 0.0;
    for (const Traced& one : pixels) {
        const double square = one.weighted().square / draws[one.drawn.stratum];
        Sums& sums = all[one.drawn.pixel];
        sums.square += square;
        sums.picture = one.picture;
        sums.samples += one.count();
        sums.light += one.count() * one.light();
        sums.variance += one.count() * one.variance();
        total += square;
    }
    std::vector<CheckedPixel> out;
    if (!(total > 0.0)) return out;
    for (const auto& [pixel, sums] : all)
        if (sums.square > 0.0)
            out.push_back({pixel % width, pixel / width, sums.square / total, sums.picture,
                           sums.light / sums.samples, std::sqrt(sums.variance) / sums.samples});
    const std::size_t kept = std::min(most, out.size());
    std::partial_sort(
        out.begin(), out.begin() + static_cast<std::ptrdiff_t>(kept), out.end(),
        [](const CheckedPixel& a, const CheckedPixel& b) { return a.share > b.share; });
    out.resize(kept);
    return out;
}

}  // namespace clgi::reference
