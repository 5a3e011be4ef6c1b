// SPDX-License-Identifier: MIT
#include "lab/flip_filters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clgi::lab {
namespace {

using std::numbers::pi;

// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees; the paper's constants.
struct Gaussian {
    double a = 0.0;
    double b = 0.0;
};
constexpr Gaussian achromatic{1.0, 0.0047};
constexpr Gaussian red_green{1.0, 0.0053};
constexpr Gaussian blue_yellow[2] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double feature_width = 0.082;  // degrees, w

// The weights before they are made to sum to 1.
Kernel bell(int radius, double sharpness) {
    Kernel kernel{radius, {}};
    for (int x = -radius; x <= radius; ++x) kernel.weights.push_back(std::exp(-sharpness * x * x));
    return kernel;
}

// Returns the sum that was there.
double normalize(Kernel& kernel) {
    double sum = 0.0;
    for (const double weight : kernel.weights) sum += weight;
    for (double& weight : kernel.weights) weight /= sum;
    return sum;
}

// Positive weights sum to 1, negative ones to -1: flat pictures have no features, and the largest
// possible edge has size 1.
void normalize_signs(Kernel& kernel) {
    double positive = 0.0, negative = 0.0;
    for (const double weight : kernel.weights) (weight > 0.0 ? positive : negative) += weight;
    for (double& weight : kernel.weights) weight /= weight > 0.0 ? positive : -negative;
}

}  // namespace

FlipFilters flip_filters(double pixels_per_degree) {
    FlipFilters filters;
    // Three standard deviations of the widest Gaussian.
    const int radius = static_cast<int>(
        std::ceil(3.0 * std::sqrt(blue_yellow[0].b / (2.0 * pi * pi)) * pixels_per_degree));
    const auto sharpness = [&](const Gaussian& g) {
        return pi * pi / (g.b * pixels_per_degree * pixels_per_degree);
    };
    filters.achromatic = bell(radius, sharpness(achromatic));
    filters.red_green = bell(radius, sharpness(red_green));
    normalize(filters.achromatic);
    normalize(filters.red_green);
    double total = 0.0;
    for (int i = 0; i < 2; ++i) {
        const Gaussian& g = blue_yellow[i];
        filters.blue_yellow[i] = bell(radius, sharpness(g));
        const double sum = normalize(filters.blue_yellow[i]);
        filters.blue_yellow_share[i] = g.a * std::sqrt(pi / g.b) * sum * sum;
        total += filters.blue_yellow_share[i];
    }
    for (double& share : filters.blue_yellow_share) share /= total;

    const double deviation = 0.5 * feature_width * pixels_per_degree;
    const int reach = static_cast<int>(std::ceil(3.0 * deviation));
    filters.smooth = bell(reach, 0.5 / (deviation * deviation));
    filters.edge = filters.point = filters.smooth;
    for (int x = -reach; x <= reach; ++x) {
        const int i = x + reach;
        filters.edge.weights[static_cast<std::size_t>(i)] *= -x;
        filters.point.weights[static_cast<std::size_t>(i)] *= x * x / (deviation * deviation) - 1.0;
    }
    normalize(filters.smooth);
    normalize_signs(filters.edge);
    normalize_signs(filters.point);
    filters.radius = std::max(radius, reach);
    return filters;
}

void filter(const Kernel& kernel, const double* in, int stride, double* out, int count) {
    std::fill(out, out + count, 0.0);
    for (int k = -kernel.radius; k <= kernel.radius; ++k) {
        const int i = kernel.radius + k;
        const double weight = kernel.weights[static_cast<std::size_t>(i)];
        const double* shifted = in + static_cast<std::ptrdiff_t>(k) * stride;
        for (int x = 0; x < count; ++x) out[x] += weight * shifted[x];
    }
}

}  // namespace clgi::lab
