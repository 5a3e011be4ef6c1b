// SPDX-License-Identifier: MIT
#include "lab/relative_error.hpp"

#include <algorithm>
#include <cmath>

#include "lab/luminance.hpp"
#include "lab/rgb_planes.hpp"

namespace clgi::lab {

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
