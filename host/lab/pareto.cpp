// SPDX-License-Identifier: MIT
#include "lab/pareto.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace clgi::lab {

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

}  // namespace clgi::lab
