// Error metrics over pixels and channels.
// SPDX-License-Identifier: MIT
#include "lab/metrics.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "io/image_formats.hpp"
#include "lab/flip.hpp"
#include "scene/luminance.hpp"

namespace clgi::lab {
namespace {

// Neumaier's compensated sum: the error does not grow with the number of samples.
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

std::string size_of(const io::Image& image) {
    return std::to_string(image.width) + "x" + std::to_string(image.height);
}

RgbPlanes planes_of(const io::Image& image, const char* which) {
    static constexpr std::array<const char*, 3> names = {"R", "G", "B"};
    const auto samples =
        static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    RgbPlanes planes{};
    for (std::size_t c = 0; c < names.size(); ++c) {
        const io::Image::Channel* channel = image.find(names[c]);
        if (!channel || channel->values.size() != samples) {
            throw InputError(std::string("compare: picture ") + which + " has no channel " +
                             names[c]);
        }
        planes[c] = &channel->values;
    }
    return planes;
}

double ratio(double numerator, double denominator, double if_both_zero) {
    if (denominator != 0.0) return numerator / denominator;
    return numerator == 0.0 ? if_both_zero : std::numeric_limits<double>::infinity();
}

double masked_mean(const RgbPlanes& planes, const Mask& mask) {
    Sum sum;
    for (const std::vector<float>* plane : planes) {
        for (std::size_t i = 0; i < plane->size(); ++i) {
            if (mask[i]) sum.add(io::finite((*plane)[i]));
        }
    }
    return sum.total() / static_cast<double>(3 * mask.pixels);
}

double nonfinite_share(const RgbPlanes& planes, const Mask& mask) {
    std::size_t count = 0;
    for (const std::vector<float>* plane : planes) {
        for (std::size_t i = 0; i < plane->size(); ++i) {
            if (mask[i] && !std::isfinite((*plane)[i])) ++count;
        }
    }
    return static_cast<double>(count) / static_cast<double>(3 * mask.pixels);
}

double psnr(double mean_square, double peak) {
    if (mean_square == 0.0) return std::numeric_limits<double>::infinity();
    return 10.0 * std::log10(peak * peak / mean_square);
}

// The smallest of values that at most one in a thousand exceeds.
double p999(std::vector<double>& values) {
    const auto rank = static_cast<std::ptrdiff_t>(values.size() - 1 - values.size() / 1000);
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    return values[static_cast<std::size_t>(rank)];
}

// Everything that looks at the samples one by one. The means of both pictures are known.
void measure_samples(const RgbPlanes& a, const RgbPlanes& b, const Mask& mask, Comparison& result) {
    // A tenth of the mean keeps dark samples from deciding the relative error alone.
    const double floor_square = 1e-2 * result.mean_b * result.mean_b;
    Sum squares, relative_squares, shares;
    std::vector<double> differences;
    differences.reserve(3 * mask.pixels);
    double peak = 0.0;
    result.max_abs = -1.0;
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < mask.counts.size(); ++i) {
            if (!mask[i]) continue;
            const double va = io::finite((*a[c])[i]), vb = io::finite((*b[c])[i]);
            const double difference = std::abs(va - vb), square = difference * difference;
            squares.add(square);
            relative_squares.add(ratio(square, vb * vb + floor_square, 0.0));
            shares.add(ratio(difference, std::abs(va) + std::abs(vb), 0.0));
            differences.push_back(difference);
            peak = std::max(peak, vb);
            if (difference > result.max_abs) {
                result.max_abs = difference;
                result.max_x = static_cast<int>(i % static_cast<std::size_t>(mask.width));
                result.max_y = static_cast<int>(i / static_cast<std::size_t>(mask.width));
            }
        }
    }
    const auto samples = static_cast<double>(differences.size());
    const double mean_square = squares.total() / samples;
    result.rmse = std::sqrt(mean_square);
    result.rel_rmse = ratio(result.rmse, result.mean_b, 0.0);
    result.rel_mse = relative_squares.total() / samples;
    result.psnr = psnr(mean_square, peak);
    result.smape = shares.total() / samples;
    result.p999_abs = p999(differences);
}

}  // namespace

std::pair<RgbPlanes, RgbPlanes> rgb_planes(const io::Image& a, const io::Image& b) {
    if (a.width != b.width || a.height != b.height) {
        throw InputError("compare: A has " + size_of(a) + " pixels, B has " + size_of(b));
    }
    if (a.width < 1 || a.height < 1) throw InputError("compare: the pictures are empty");
    return {planes_of(a, "A"), planes_of(b, "B")};
}

double mean(const std::vector<float>& map, const Mask& mask) {
    Sum sum;
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (mask[i]) sum.add(map[i]);
    }
    return sum.total() / static_cast<double>(mask.pixels);
}

Comparison compare(const io::Image& a, const io::Image& b, const CompareOptions& options) {
    const auto [planes_a, planes_b] = rgb_planes(a, b);
    const Mask mask = options.mask ? *options.mask : whole_picture(a.width, a.height);
    check_mask(mask, a.width, a.height);

    Comparison result;
    result.width = a.width;
    result.height = a.height;
    result.pixels = mask.pixels;
    result.mean_a = masked_mean(planes_a, mask);
    result.mean_b = masked_mean(planes_b, mask);
    result.energy_ratio = ratio(result.mean_a, result.mean_b, 1.0);
    result.nonfinite_a = nonfinite_share(planes_a, mask);
    result.nonfinite_b = nonfinite_share(planes_b, mask);
    measure_samples(planes_a, planes_b, mask, result);
    if (options.flip) result.flip = mean(hdr_flip(a, b), mask);
    return result;
}

std::vector<double> luminance_of(const io::Image& picture) {
    const auto plane = [&](const char* name) { return picture.find(name)->values.data(); };
    return luminances(
        {plane("R"), plane("G"), plane("B")},
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
}

double relative_error(const io::Image& a, const io::Image& b, const Mask* mask) {
    if (mask) check_mask(*mask, b.width, b.height);
    const auto [planes, truth] = rgb_planes(a, b);
    const io::Image::Channel* noise = b.find("error.Y");
    const std::size_t pixels = truth[0]->size();
    double square = 0.0, mean = 0.0;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (mask && !(*mask)[i]) continue;
        double difference = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            difference += luminance_weights[c] * (double{(*planes[c])[i]} - double{(*truth[c])[i]});
            mean += luminance_weights[c] * double{(*truth[c])[i]};
        }
        square += difference * difference;
        if (noise) square -= double{noise->values[i]} * double{noise->values[i]};
    }
    const auto count = static_cast<double>(mask ? mask->pixels : pixels);
    return mean > 0.0 ? std::sqrt(std::max(square, 0.0) / count) / (mean / count) : 0.0;
}

double luminance_ratio(const io::Image& a, const io::Image& b, const Mask* mask) {
    const auto sum = [&](const io::Image& picture) {
        const std::vector<double> values = luminance_of(picture);
        double out = 0.0;
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!mask || (*mask)[i]) out += values[i];
        return out;
    };
    return sum(a) / sum(b);
}

}  // namespace clgi::lab
