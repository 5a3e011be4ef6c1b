// SPDX-License-Identifier: MIT
#include "lab/difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "io/image_formats.hpp"
#include "lab/flip.hpp"
#include "lab/metrics.hpp"

namespace clgi::lab {
namespace {

enum class Pixel : std::uint8_t { counts, does_not, nonfinite };

std::vector<Pixel> classify(const RgbPlanes& a, const RgbPlanes& b, const Mask& mask) {
    std::vector<Pixel> pixels(mask.counts.size(), Pixel::counts);
    for (const RgbPlanes* planes : {&a, &b}) {
        for (const std::vector<float>* plane : *planes) {
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                if (!std::isfinite((*plane)[i])) pixels[i] = Pixel::nonfinite;
            }
        }
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!mask[i]) pixels[i] = Pixel::does_not;
    }
    return pixels;
}

std::vector<double> differences(const RgbPlanes& a, const RgbPlanes& b, Shown shown) {
    std::vector<double> values(a[0]->size(), 0.0);
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < values.size(); ++i) {
            const double va = io::finite((*a[c])[i]), vb = io::finite((*b[c])[i]);
            values[i] += (shown == Shown::size ? std::abs(va - vb) : va - vb) / 3.0;
        }
    }
    return values;
}

// Neither a few bright pixels nor a mostly black difference may hide the rest.
double chosen_scale(const std::vector<double>& values, const std::vector<Pixel>& pixels) {
    std::vector<double> sizes;
    sizes.reserve(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (pixels[i] == Pixel::counts) sizes.push_back(std::abs(values[i]));
    }
    if (sizes.empty()) return 0.0;
    const auto rank = static_cast<std::ptrdiff_t>((sizes.size() - 1) * 99 / 100);
    std::nth_element(sizes.begin(), sizes.begin() + rank, sizes.end());
    const double scale = sizes[static_cast<std::size_t>(rank)];
    return round_up(scale > 0.0 ? scale : *std::max_element(sizes.begin(), sizes.end()));
}

const std::map<Shown, const char*> captions = {
    {Shown::difference, "A-B"}, {Shown::size, "|A-B|"}, {Shown::flip, "FLIP"}};

// Where nothing differs the bar has the one colour of 0.
Scale scale_of(Shown shown, double size) {
    const auto signed_color = [](double t) { return diverging_color(2.0 * t - 1.0); };
    const auto flat = [shown](double) {
        return shown == Shown::difference ? diverging_color(0.0) : sequential_color(0.0);
    };
    if (!(size > 0.0)) return {0.0, 0.0, flat, captions.at(shown)};
    if (shown == Shown::difference) return {-size, size, signed_color, captions.at(shown)};
    return {0.0, size, sequential_color, captions.at(shown)};
}

// ---- colour maps --------------------------------------------------------------------------------

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

DifferencePicture difference_picture(const io::Image& a, const io::Image& b,
                                     const DifferenceOptions& options) {
    const auto [planes_a, planes_b] = rgb_planes(a, b);
    const Mask mask = options.mask ? *options.mask : whole_picture(a.width, a.height);
    check_mask(mask, a.width, a.height);

    const bool is_flip = options.shown == Shown::flip;
    std::vector<double> values;
    if (is_flip) {
        const std::vector<float> map = options.flip ? *options.flip : hdr_flip(a, b);
        values.assign(map.begin(), map.end());
    } else {
        values = differences(planes_a, planes_b, options.shown);
    }
    const std::vector<Pixel> pixels = classify(planes_a, planes_b, mask);
    double size = options.scale;
    if (!(size > 0.0)) size = is_flip ? 1.0 : chosen_scale(values, pixels);

    DifferencePicture picture{{a.width, a.height, {}}, scale_of(options.shown, size)};
    const auto color_of = options.shown == Shown::difference ? diverging_color : sequential_color;
    for (std::size_t i = 0; i < values.size(); ++i) {
        // Where nothing differs the scale is 0, and so are all values.
        const Color color = pixels[i] == Pixel::does_not ? uncounted_color
                            : pixels[i] == Pixel::nonfinite
                                ? nonfinite_color
                                : color_of(size > 0.0 ? values[i] / size : 0.0);
        picture.raster.rgba.insert(picture.raster.rgba.end(), {color[0], color[1], color[2], 255});
    }
    return picture;
}

Raster with_scale_bar(const Raster& picture, const Scale& scale) {
    const Drawing drawing;
    drawing.add("picture.png", picture);
    nlohmann::ordered_json data = {
        {"from", scale.from}, {"to", scale.to}, {"caption", scale.caption}};
    for (int i = 0; i < 256; ++i) data["colors"].push_back(scale.color(i / 255.0));
    const std::string why = drawing.draw("scale_bar", data);
    if (why.empty()) return drawing.picture("scaled.png");
    fmt::print(stderr, "clgi: no scale bar: {}\n", why);
    return picture;
}

double round_up(double value) {
    if (!(value > 0.0)) return 0.0;
    const double power = std::pow(10.0, std::floor(std::log10(value)));
    for (const double step : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}) {
        // A quotient of decimal fractions may miss its own step by its last bits.
        if (value <= step * power * (1.0 + 1e-12)) return step * power;
    }
    return 10.0 * power;
}

}  // namespace clgi::lab
