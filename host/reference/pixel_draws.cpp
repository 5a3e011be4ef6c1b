// SPDX-License-Identifier: MIT
#include "reference/pixel_draws.hpp"

#include <algorithm>
#include <cmath>

namespace clgi::reference {
namespace {

// Every pixel once, in blocks of about a hundredth of the picture, back and forth.
template <typename Visit>
void walk_blocks(std::size_t width, std::size_t height, Visit&& visit) {
    const double side = std::sqrt(static_cast<double>(width * height) / 128.0);
    const std::size_t block = std::max<std::size_t>(static_cast<std::size_t>(side), 1);
    const std::size_t across = (width + block - 1) / block;
    bool back = false;
    for (std::size_t top = 0; top < height; top += block, back = !back)
        for (std::size_t k = 0; k < across; ++k) {
            const std::size_t left = (back ? across - 1 - k : k) * block;
            for (std::size_t y = top; y < std::min(top + block, height); ++y)
                for (std::size_t x = left; x < std::min(left + block, width); ++x)
                    if (!visit(y * width + x)) return;
        }
}

}  // namespace

PixelDraws::PixelDraws(const Brightness& brightness) : brightness_(brightness) {
    const auto pixels = static_cast<double>(brightness.values.size());
    for (const float value : brightness.values) {
        mean_ += double{value} / pixels;
        size_ += std::abs(double{value}) / pixels;
    }
    for (std::size_t k = 0; k < brightness.values.size(); ++k) total_ += share(k);
}

double PixelDraws::share(std::size_t pixel) const {
    if (!(size_ > 0.0)) return 1.0;
    const double bright = std::abs(double{brightness_.values[pixel]}) / size_;
    return (1.0 + std::min(bright, 4.0) + bright) / 3.0;
}

std::vector<DrawnPixel> PixelDraws::draw(const std::vector<int>& counts, Random& random) const {
    std::vector<DrawnPixel> out;
    std::vector<double> at;  // where in the sum of shares
    const double stratum = total_ / static_cast<double>(counts.size());
    for (std::size_t s = 0; s < counts.size(); ++s) {
        const auto first = static_cast<std::ptrdiff_t>(at.size());
        for (int k = 0; k < counts[s]; ++k) {
            // Of 48 bits: a picture may have more pixels than a float has steps.
            const double fine = double{random()} + 0x1p-24 * double{random()};
            at.push_back((static_cast<double>(s) + fine) * stratum);
            out.push_back({0, s, 0.0});
        }
        std::sort(at.begin() + first, at.end());
    }
    const double mean_share = total_ / static_cast<double>(brightness_.values.size());
    std::size_t next = 0, last = 0;
    double sum = 0.0;
    const auto put = [&](std::size_t pixel) {
        out[next].pixel = pixel;
        out[next++].weight = mean_share / share(pixel);
    };
    walk_blocks(brightness_.width, brightness_.height, [&](std::size_t pixel) {
        last = pixel;
        sum += share(pixel);
        while (next < at.size() && at[next] < sum) put(pixel);
        return next < at.size();
    });
    while (next < at.size()) put(last);  // rounding of the sum
    return out;
}

}  // namespace clgi::reference
