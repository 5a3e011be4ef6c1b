// Error metrics over pixels and channels.
// SPDX-License-Identifier: MIT
#include "report/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/image_formats.hpp"
#include "report/rgb_planes.hpp"

namespace clgi::report {
namespace {

// Neumaier's sum: the error does not grow with the number of samples.
class Sum {
public:
    void add(double value) {
        const double next = sum_ + value;
        lost_ += std::abs(sum_) >= std::abs(value) ? (sum_ - next) + value : (value - next) + sum_;
        sum_ = next;
    }
    // What an infinite sum has lost is infinity minus infinity.
    double total() const { return std::isfinite(sum_) ? sum_ + lost_ : sum_; }

private:
    double sum_ = 0.0;
    double lost_ = 0.0;
};

double ratio(double numerator, double denominator, double if_both_zero) {
    if (denominator != 0.0) return numerator / denominator;
    return numerator == 0.0 ? if_both_zero : std::numeric_limits<double>::infinity();
}

double mean(const RgbPlanes& planes) {
    Sum sum;
    for (const std::vector<float>* plane : planes) {
        for (const float sample : *plane) sum.add(io::finite(sample));
    }
    return sum.total() / static_cast<double>(3 * planes[0]->size());
}

double nonfinite_share(const RgbPlanes& planes) {
    std::size_t count = 0;
    for (const std::vector<float>* plane : planes) {
        count += static_cast<std::size_t>(
            std::count_if(plane->begin(), plane->end(), [](float v) { return !std::isfinite(v); }));
    }
    return static_cast<double>(count) / static_cast<double>(3 * planes[0]->size());
}

double psnr(double mean_square, double peak) {
    if (mean_square == 0.0) return std::numeric_limits<double>::infinity();
    return 10.0 * std::log10(peak * peak / mean_square);
}

}  // namespace

Comparison compare(const io::Image& a, const io::Image& b) {
    const auto [planes_a, planes_b] = rgb_planes(a, b);
    Comparison result;
    result.width = a.width;
    result.height = a.height;
    result.mean_a = mean(planes_a);
    result.mean_b = mean(planes_b);
    result.nonfinite_a = nonfinite_share(planes_a);
    result.nonfinite_b = nonfinite_share(planes_b);

    // A tenth of the mean keeps dark samples from deciding the relative error alone.
    const double floor_square = 1e-2 * result.mean_b * result.mean_b;
    Sum squares, relative_squares, shares;
    double peak = 0.0;
    const std::size_t pixels = planes_a[0]->size();
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < pixels; ++i) {
            const double va = io::finite((*planes_a[c])[i]), vb = io::finite((*planes_b[c])[i]);
            const double difference = std::abs(va - vb), square = difference * difference;
            squares.add(square);
            relative_squares.add(ratio(square, vb * vb + floor_square, 0.0));
            shares.add(ratio(difference, std::abs(va) + std::abs(vb), 0.0));
            peak = std::max(peak, vb);
            if (difference > result.max_abs) {
                result.max_abs = difference;
                result.max_x = static_cast<int>(i % static_cast<std::size_t>(a.width));
                result.max_y = static_cast<int>(i / static_cast<std::size_t>(a.width));
            }
        }
    }
    const auto samples = static_cast<double>(3 * pixels);
    const double mean_square = squares.total() / samples;
    result.rmse = std::sqrt(mean_square);
    result.rel_rmse = ratio(result.rmse, result.mean_b, 0.0);
    result.rel_mse = relative_squares.total() / samples;
    result.psnr = psnr(mean_square, peak);
    result.smape = shares.total() / samples;
    result.energy_ratio = ratio(result.mean_a, result.mean_b, 1.0);
    return result;
}

}  // namespace clgi::report
