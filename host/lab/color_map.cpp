// SPDX-License-Identifier: MIT
#include "lab/color_map.hpp"

#include <algorithm>
#include <cmath>

namespace clgi::lab {
namespace {

// A colour in OKLCh: hue in radians.
struct Polar {
    double lightness;
    double chroma;
    double hue;
};

constexpr Polar neutral{0.97, 0.0, 0.0};
constexpr Polar red_end{0.45, 0.17,
                        0.49};  // as much chroma as sRGB has of both hues at that lightness
constexpr Polar blue_end{0.45, 0.17, 4.60};

constexpr Polar darkest{0.22, 0.095, 5.41};
constexpr Polar lightest{0.93, 0.095, 1.75};

double between(double from, double to, double share) { return from + (to - from) * share; }

std::uint8_t srgb_byte(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1.0 / 2.4) - 0.055;
    return static_cast<std::uint8_t>(std::lround(255.0 * encoded));
}

Color to_srgb(const Polar& color) {
    const double a = color.chroma * std::cos(color.hue), b = color.chroma * std::sin(color.hue);
    const auto cube = [](double v) { return v * v * v; };
    const double l = cube(color.lightness + 0.3963377774 * a + 0.2158037573 * b);
    const double m = cube(color.lightness - 0.1055613458 * a - 0.0638541728 * b);
    const double s = cube(color.lightness - 0.0894841775 * a - 1.2914855480 * b);
    return {srgb_byte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            srgb_byte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            srgb_byte(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

}  // namespace

Color diverging_color(double value) {
    const double size = std::min(std::abs(value), 1.0);
    const Polar& end = value < 0.0 ? blue_end : red_end;
    return to_srgb({between(neutral.lightness, end.lightness, size),
                    between(neutral.chroma, end.chroma, size), end.hue});
}

Color sequential_color(double value) {
    const double size = std::clamp(value, 0.0, 1.0);
    return to_srgb({between(darkest.lightness, lightest.lightness, size),
                    between(darkest.chroma, lightest.chroma, size),
                    between(darkest.hue, lightest.hue, size)});
}

}  // namespace clgi::lab
