// The signed difference of two pictures on a diverging colour map.
//
// The map is two straight lines in OKLCh, a space whose distances match what the eye sees: from
// nearly white down in lightness and up in chroma, alike in both hues.
// SPDX-License-Identifier: MIT
#include "report/difference.hpp"

#include <algorithm>
#include <cmath>

#include "io/image_formats.hpp"
#include "report/rgb_planes.hpp"

namespace clgi::report {
namespace {

constexpr double lightness_at_zero = 0.97;
constexpr double lightness_at_one = 0.45;
constexpr double chroma_at_one = 0.17;  // as much as sRGB has of both hues at that lightness
constexpr double red_hue = 0.49;        // radians
constexpr double blue_hue = 4.60;

std::uint8_t srgb_byte(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

// OKLab (Ottosson 2020) to linear sRGB.
std::array<double, 3> linear_rgb(double lightness, double a, double b) {
    const auto cube = [](double v) { return v * v * v; };
    const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
    return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

std::vector<double> signed_differences(const io::Image& a, const io::Image& b) {
    const auto [planes_a, planes_b] = rgb_planes(a, b);
    std::vector<double> differences(planes_a[0]->size(), 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < differences.size(); ++i) {
            const double va = io::finite((*planes_a[c])[i]), vb = io::finite((*planes_b[c])[i]);
            differences[i] += (va - vb) / 3.0;
        }
    }
    return differences;
}

// Neither a few bright pixels nor a mostly black difference may hide the rest.
double chosen_scale(const std::vector<double>& differences) {
    std::vector<double> sizes;
    sizes.reserve(differences.size());
    for (const double difference : differences) sizes.push_back(std::abs(difference));
    const auto rank = static_cast<std::ptrdiff_t>((sizes.size() - 1) * 99 / 100);
    std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
    const double scale = sizes[static_cast<std::size_t>(rank)];
    return scale > 0.0 ? scale : *std::max_element(sizes.begin(), sizes.end());
}

}  // namespace

std::array<std::uint8_t, 3> diverging_color(double value) {
    const double size = std::min(std::abs(value), 1.0);
    const double hue = value < 0.0 ? blue_hue : red_hue;
    const double chroma = chroma_at_one * size;
    const auto rgb = linear_rgb(lightness_at_zero + (lightness_at_one - lightness_at_zero) * size,
                                chroma * std::cos(hue), chroma * std::sin(hue));
    return {srgb_byte(rgb[0]), srgb_byte(rgb[1]), srgb_byte(rgb[2])};
}

DifferencePicture difference_picture(const io::Image& a, const io::Image& b, double scale) {
    const std::vector<double> differences = signed_differences(a, b);
    DifferencePicture picture;
    picture.width = a.width;
    picture.height = a.height;
    picture.scale = scale > 0.0 ? scale : chosen_scale(differences);
    picture.rgba.reserve(4 * differences.size());
    for (const double difference : differences) {
        const auto color = diverging_color(picture.scale > 0.0 ? difference / picture.scale : 0.0);
        picture.rgba.insert(picture.rgba.end(), {color[0], color[1], color[2], 255});
    }
    return picture;
}

}  // namespace clgi::report
