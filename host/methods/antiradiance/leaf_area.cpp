// SPDX-License-Identifier: MIT
#include "methods/antiradiance/leaf_area.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clgi {
namespace {

// Steps of the search for an area. More would tell apart triangles that differ by rounding alone,
// and cut one half of a wall finer than the other.
constexpr int steps = 20;

}  // namespace

int halvings(double area, double max_area) {
    constexpr double rounding = 1e-9, most = 1000.0;
    const double needed = std::ceil(std::log2(area / max_area) - rounding);
    return static_cast<int>(std::clamp(needed, 0.0, most));
}

double count_leaves(const std::vector<Face>& faces, double max_area) {
    double out = 0.0;
    for (const Face& face : faces) out += std::ldexp(1.0, halvings(face.area, max_area));
    return out;
}

double leaf_area(const std::vector<Face>& faces, const ElementOptions& options) {
    if (faces.empty()) return std::numeric_limits<double>::infinity();
    if (options.max_area > 0.0) return options.max_area;
    double total = 0.0;
    for (const Face& face : faces) total += face.area;
    const auto requested = static_cast<double>(options.requested);
    // At `fine` there are twice as many leaves and more.
    double fine = 0.5 * total / requested, coarse = 4.0 * total / requested;
    if (count_leaves(faces, coarse) < requested) {
        for (int step = 0; step < steps; ++step) {
            const double middle = std::sqrt(fine * coarse);
            (count_leaves(faces, middle) < requested ? coarse : fine) = middle;
        }
        if (count_leaves(faces, fine) - requested < requested - count_leaves(faces, coarse))
            coarse = fine;
    }
    return std::max(coarse, options.min_area);
}

}  // namespace clgi
