// SPDX-License-Identifier: MIT
#include "plan/surface_points.hpp"

#include <clgi/shared/halton.h>
#include <algorithm>
#include <cmath>

namespace clgi {

std::vector<SurfacePoint> surface_points(const std::vector<LocalTriangle>& triangles,
                                         const std::vector<double>& weights, std::size_t count) {
    std::vector<double> sums;  // of areas of sides
    sums.reserve(triangles.size());
    double sum = 0.0;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const double area = weights[t] > 0.0 && !triangles[t].is_line() ? triangles[t].area : 0.0;
        sums.push_back(sum += area * (triangles[t].double_sided ? 2.0 : 1.0));
    }
    std::vector<SurfacePoint> out;
    if (!(sum > 0.0)) return out;
    for (std::uint32_t i = 0; i < count; ++i) {
        const double target = (i + 0.5) / static_cast<double>(count) * sum;
        const auto found = std::upper_bound(sums.begin(), sums.end(), target);
        const auto t = static_cast<std::uint32_t>(std::min(found, sums.end() - 1) - sums.begin());
        const LocalTriangle& on = triangles[t];
        const double before = t > 0 ? sums[t - 1] : 0.0;
        const bool back = on.double_sided && target - before > on.area;
        const double root = std::sqrt(double{radical_inverse(i + 1, 2)});
        const double v = radical_inverse(i + 1, 3);
        out.push_back({on.corners[0] * (1.0 - root) + on.corners[1] * (root * (1.0 - v)) +
                           on.corners[2] * (root * v),
                       back ? -on.normal : on.normal, t});
    }
    return out;
}

}  // namespace clgi
