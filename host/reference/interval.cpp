// SPDX-License-Identifier: MIT
#include "reference/interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clgi::reference {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// How far the mean over strata may lie from the one that was found: down to mean - below, up to
// mean + above.
struct Reach {
    double mean = 0.0;
    double below = 0.0;
    double above = 0.0;
};

// One stratum's part in the moments of the mean.
struct Moments {
    double mean = 0.0;
    double variance = 0.0;  // of the mean of the stratum
    double third = 0.0;     // its third central moment
    double largest = 0.0;   // deviation of a draw, as it counts in the mean
    double draws = 0.0;
};

template <typename Value>
Moments moments(const std::vector<Draw>& draws, std::size_t first, std::size_t end, Value&& value) {
    Moments out;
    out.draws = static_cast<double>(end - first);
    for (std::size_t k = first; k < end; ++k) out.mean += value(draws[k]) / out.draws;
    const double others = out.draws - 1.0;
    for (std::size_t k = first; k < end; ++k) {
        const double deviation = value(draws[k]) - out.mean;
        out.variance += deviation * deviation / (others * out.draws);
        if (out.draws > 2.0)
            out.third +=
                deviation * deviation * deviation / (others * (out.draws - 2.0) * out.draws);
        out.largest = std::max(out.largest, std::abs(deviation) / others);
    }
    return out;
}

template <typename Visit>
void for_each_stratum(const std::vector<Draw>& draws, Visit&& visit) {
    for (std::size_t first = 0; first < draws.size();) {
        std::size_t end = first;
        while (end < draws.size() && draws[end].stratum == draws[first].stratum) ++end;
        visit(first, end);
        first = end;
    }
}

// The interval is that of Student's t, with three precautions for values of which few draws have
// most:
// - The degrees of freedom are those of the variances of the strata (Satterthwaite 1946). They are
//   few if few strata have most of the variance.
// - Skewness moves the end on its side outwards (Hall 1992).
// - What was not seen in n draws may have a probability of 3/n, and it may be as far from the mean
//   as the farthest draw.
template <typename Value>
Reach reach(const std::vector<Draw>& draws, Value&& value) {
    double strata = 0.0, variance = 0.0, third = 0.0, squares = 0.0, largest = 0.0;
    Reach out;
    for_each_stratum(draws, [&](std::size_t first, std::size_t end) {
        const Moments found = moments(draws, first, end, value);
        strata += 1.0;
        out.mean += found.mean;
        variance += found.variance;
        third += found.third;
        squares += found.variance * found.variance / (found.draws + 1.0);
        largest = std::max(largest, found.largest);
    });
    out.mean /= std::max(strata, 1.0);
    if (!(variance > 0.0)) return out;
    const double t = student_t(variance * variance / squares);
    const double error = std::sqrt(variance) / strata;
    const double half = std::hypot(t * error, 3.0 * largest / strata);
    const double skew = third / (variance * std::sqrt(variance)) * (1.0 + 2.0 * 3.84) / 6.0 * error;
    out.below = half + std::max(-skew, 0.0);
    out.above = half + std::max(skew, 0.0);
    return out;
}

// The slope of the truth over the picture, within strata. The picture's mean is known exactly, so
// what the picture explains adds no uncertainty to the mean of the truth.
double slope(const std::vector<Draw>& draws) {
    double both = 0.0, picture = 0.0;
    for_each_stratum(draws, [&](std::size_t first, std::size_t end) {
        const Moments x = moments(draws, first, end, [](const Draw& d) { return d.picture; });
        const Moments y = moments(draws, first, end, [](const Draw& d) { return d.light; });
        for (std::size_t k = first; k < end; ++k) {
            both += (draws[k].picture - x.mean) * (draws[k].light - y.mean);
            picture += (draws[k].picture - x.mean) * (draws[k].picture - x.mean);
        }
    });
    return picture > 0.0 ? std::clamp(both / picture, 0.0, 1.0) : 0.0;
}

double quotient(double above, double below, double if_both_zero) {
    if (below > 0.0) return above / below;
    return above > 0.0 ? infinite : if_both_zero;
}

// Where a falling function is 0.
template <typename Function>
double root(double low, double high, Function&& f) {
    for (int k = 0; k < 100 && high > low * (1.0 + 1e-9); ++k) {
        const double middle = 0.5 * (low + high);
        (f(middle) > 0.0 ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace

double student_t(double degrees) {
    // Straight lines in 1/degrees lie above the curve.
    constexpr double table[][2] = {{1.0, 12.706},      {1.0 / 1.5, 6.5},    {1.0 / 2.0, 4.303},
                                   {1.0 / 3.0, 3.182}, {1.0 / 4.0, 2.776},  {1.0 / 6.0, 2.447},
                                   {1.0 / 10, 2.228},  {1.0 / 30.0, 2.042}, {0.0, 1.960}};
    const double at = 1.0 / std::max(degrees, 1.0);
    std::size_t row = 1;
    while (table[row][0] > at) ++row;
    const double share = (at - table[row][0]) / (table[row - 1][0] - table[row][0]);
    return table[row][1] + share * (table[row - 1][1] - table[row][1]);
}

// The squared relative error is D / M^2: the mean squared difference over the squared mean of the
// truth. A value q of it is in the interval if 0 is in the interval of D - q M^2 (Fieller 1954).
// M^2 is linear in the draws here, by its tangent.
ErrorAndEnergy estimate(const std::vector<Draw>& draws, double picture) {
    const double follow = slope(draws);
    const auto light = [&](const Draw& draw) { return draw.light - follow * draw.picture; };
    Reach mean = reach(draws, light);
    mean.mean += follow * picture;
    const double truth = std::max(mean.mean, 0.0);
    const double least = std::max(truth - mean.below, 0.0), most = truth + mean.above;

    ErrorAndEnergy out;
    out.energy = {quotient(picture, truth, 1.0), quotient(picture, most, 1.0),
                  quotient(picture, least, 1.0)};
    const Reach square = reach(draws, [](const Draw& draw) { return draw.square; });
    const double found = std::max(square.mean, 0.0);  // noise alone makes it negative
    const double ratio = quotient(found, truth * truth, 0.0);
    out.error.value = std::sqrt(ratio);
    const auto at = [&](double q) {
        return reach(draws,
                     [&](const Draw& draw) { return draw.square - 2.0 * q * truth * light(draw); });
    };
    const auto lower = [&](double q) { return found - q * truth * truth - at(q).below; };
    const auto upper = [&](double q) { return found - q * truth * truth + at(q).above; };
    if (ratio < infinite && lower(0.0) > 0.0) out.error.low = std::sqrt(root(0.0, ratio, lower));

    // Both at their ends: wider, but it exists even if M is hardly known.
    const double widest = quotient(found + square.above, least * least, 0.0);
    out.error.high = std::sqrt(widest);
    // Where all is black there may be light that no sample has met.
    if (!(truth > 0.0) && !(picture > 0.0)) {
        out.error.high = infinite;
        out.energy.low = 0.0;
        return out;
    }
    constexpr double endless = 1e30;
    double end = std::max(ratio, 1e-12);
    while (end < std::min(widest, endless) && upper(end) > 0.0) end *= 2.0;
    if (end < std::min(widest, endless)) out.error.high = std::sqrt(root(ratio, end, upper));
    // The difference of means is a part of the error, also where no pixel met light twice.
    const auto off = [](double energy) { return std::abs(energy - 1.0); };
    if (out.error.high < off(out.energy.value))
        out.error.high = std::max(off(out.energy.low), off(out.energy.high));
    return out;
}

}  // namespace clgi::reference
