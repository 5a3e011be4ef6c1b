// SPDX-License-Identifier: MIT
#include "lab/hdr_flip.hpp"

#include <algorithm>
#include <cmath>

#include "io/image_formats.hpp"
#include "lab/flip.hpp"
#include "lab/metrics.hpp"

namespace clgi::lab {
namespace {

// ACES in Narkowicz's fit, (a x^2 + b x) / (d x^2 + e x + f), x scaled by 0.6 as in the paper.
struct Aces {
    static constexpr double a = 0.6 * 0.6 * 2.51, b = 0.6 * 0.03;
    static constexpr double d = 0.6 * 0.6 * 2.43, e = 0.6 * 0.59, f = 0.14;
};
constexpr double shown_as = 0.85;  // t: what the brightest and the median pixel are tone mapped to

// Steps of a stop would be endless between a sun and a starlit wall.
constexpr int most_exposures = 32;

double tone_mapped(double x) {
    return x * (Aces::a * x + Aces::b) / (x * (Aces::d * x + Aces::e) + Aces::f);
}

// Solves tone_mapped(x) = shown_as.
double shown_radiance() {
    const double p = Aces::a - shown_as * Aces::d, q = Aces::b - shown_as * Aces::e,
                 r = -shown_as * Aces::f;
    return (-q + std::sqrt(q * q - 4.0 * p * r)) / (2.0 * p);
}

double not_negative(float sample) { return std::max(io::finite(sample), 0.0f); }

// Of the pixels that are finite and not black, whose exposure would be infinite.
std::vector<double> lit_luminances(const RgbPlanes& planes) {
    std::vector<double> result;
    for (std::size_t i = 0; i < planes[0]->size(); ++i) {
        const float r = (*planes[0])[i], g = (*planes[1])[i], b = (*planes[2])[i];
        if (!std::isfinite(r) || !std::isfinite(g) || !std::isfinite(b)) continue;
        const double y =
            0.2126 * not_negative(r) + 0.7152 * not_negative(g) + 0.0722 * not_negative(b);
        if (y > 0.0) result.push_back(y);
    }
    return result;
}

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

Exposures exposures(const RgbPlanes& planes) {
    std::vector<double> values = lit_luminances(planes);
    if (values.empty()) return {};
    const double brightest = *std::max_element(values.begin(), values.end());
    const double middle = median(values), shown = shown_radiance();
    const double stops = std::log2(brightest / middle);
    Exposures range{shown / brightest, shown / middle, 1};
    if (stops > 0.0) {
        range.count = std::clamp(static_cast<int>(std::ceil(stops)), 2, most_exposures);
    }
    return range;
}

Display displayed(const RgbPlanes& planes, int width, int height, double exposure) {
    Display display{width, height, {}};
    for (std::size_t c = 0; c < 3; ++c) {
        display.rgb[c].reserve(planes[c]->size());
        for (const float sample : *planes[c]) {
            const double shown = tone_mapped(exposure * not_negative(sample));
            display.rgb[c].push_back(static_cast<float>(std::min(shown, 1.0)));
        }
    }
    return display;
}

}  // namespace

double Exposures::at(int i) const {
    if (count < 2) return first;
    return first * std::pow(last / first, static_cast<double>(i) / (count - 1));
}

Exposures exposures(const io::Image& picture) {
    return exposures(rgb_planes(picture, picture).first);
}

std::vector<float> hdr_flip(const io::Image& test, const io::Image& reference) {
    const auto [tested, truth] = rgb_planes(test, reference);
    std::vector<float> map(truth[0]->size(), 0.0f);
    Exposures range = exposures(truth);
    // A black picture has no exposure of its own: light in the other one must not go unseen.
    if (range.count == 0) range = exposures(tested);
    for (int i = 0; i < range.count; ++i) {
        const double exposure = range.at(i);
        const std::vector<float> errors = flip(displayed(tested, test.width, test.height, exposure),
                                               displayed(truth, test.width, test.height, exposure));
        std::transform(map.begin(), map.end(), errors.begin(), map.begin(),
                       [](float so_far, float here) { return std::max(so_far, here); });
    }
    return map;
}

}  // namespace clgi::lab
